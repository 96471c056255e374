// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <functional>
#include <string>

namespace pcl::cosection {

/** \brief The file that \a path stands for: behind symbolic links, also behind one to a file that does
 * not exist yet. \throws IoError if the links go round in circles */
std::string followLinks (const std::string& path);

/** \brief Whether a name is \a prefix and the number of a process that is gone, as of what it left behind. */
PCL_COSECTION_EXPORT bool isOfGoneProcess (const std::string& name, const std::string& prefix);

/** \brief How names of temporary files and folders begin; the number of their process and "-" follow. */
constexpr const char* temporary_prefix = ".cosection-";

/** \brief Let \a write fill a file of a temporary name beside \a path, then rename it to \a path.
 * If \a write throws, or anything fails, the temporary file is removed and \a path is untouched.
 * A symbolic link stays one: the file that it points to is replaced, or made. Temporary files of processes that are
 * gone are removed from the folder.
 * \throws IoError naming \a path and the system's reason */
PCL_COSECTION_EXPORT void writeAtomically (const std::string& path,
                                           const std::function<void (const std::string& temporary_path)>& write);

/** \brief Make and remove a temporary file as writeAtomically () does, to find out whether files can be made in a
 * folder.
 * \throws std::system_error with the system's reason */
PCL_COSECTION_EXPORT void tryToWriteIn (const std::string& folder);

/** \brief Replace the contents of a file. \throws std::system_error with the system's reason, which
 * writeAtomically () turns into an IoError that names the final path. */
PCL_COSECTION_EXPORT void writeBytes (const std::string& path, const std::string& bytes);

/** \brief The contents of a regular file. \throws IoError naming \a path and the system's reason */
PCL_COSECTION_EXPORT std::string readBytes (const std::string& path);

} // namespace pcl::cosection
