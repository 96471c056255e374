// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <string>

namespace pcl::cosection {

/** \brief Replace the contents of a file. \throws std::system_error with the system's reason, which
 * writeAtomically () turns into an IoError that names the final path. */
PCL_COSECTION_EXPORT void writeBytes (const std::string& path, const std::string& bytes);

/** \brief \throws IoError naming \a path and the system's reason */
PCL_COSECTION_EXPORT std::string readBytes (const std::string& path);

} // namespace pcl::cosection
