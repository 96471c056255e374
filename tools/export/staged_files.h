// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/** \brief A folder within another one, in which files are written that then take their places in that one together: a
 * run that fails or is stopped before leaves what was there as it was. */
class StagedFiles
{
public:
  /** \brief Makes the folder. Those of runs that are gone are removed. \param[in] output must exist
   * \throws pcl::cosection::IoError */
  explicit StagedFiles (const std::string& output);
  StagedFiles (const StagedFiles&) = delete;
  StagedFiles& operator= (const StagedFiles&) = delete;
  ~StagedFiles (); ///< removes what did not take its place

  /** \brief Where to write. */
  std::string folder () const { return staging_.string (); }

  /** \brief Move files to their places. Files beside subfolders name those within: the old ones are removed first, and
   * the new ones come last, so that at no time they name what is of another run. A symbolic link stays one.
   * \param[in] files within folder () \return where they are now, in the same order
   * \throws pcl::cosection::IoError, with nothing changed, if one of the places cannot be written to */
  std::vector<std::string> publish (const std::vector<std::string>& files) const;

private:
  std::filesystem::path output_, staging_;
};
