// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace pcl::cosection {

/** \brief A folder under a temporary name, which gets its own name when all is in it; else nothing is left. */
class NewFolder
{
public:
  /** \throws IoError if there is a file of this name, or a folder that is not empty, or it cannot be made */
  explicit NewFolder (const std::string& path);
  ~NewFolder ();

  NewFolder (const NewFolder&) = delete;
  NewFolder& operator= (const NewFolder&) = delete;

  /** \brief The present path of what is called \a name in the folder. */
  std::string file (const std::string& name) const { return (temporary_ / name).string (); }

  /** \throws IoError */
  void makeFolder (const std::string& name) const;

  /** \throws IoError */
  void writeText (const std::string& name, const std::string& text) const;

  /** \brief Call \a write, then give the folder its name. \throws what \a write throws; messages of an IoError have the
   * folder's own name */
  void fill (const std::function<void ()>& write);

private:
  std::filesystem::path path_;
  std::filesystem::path temporary_; // empty: it has its name
};

} // namespace pcl::cosection
