// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "command_line.h"

#include <pcl/cosection/surface/co_section.h>

#include <string>
#include <vector>

/** \brief The files that a run writes. */
class OutputTarget
{
public:
  /** \brief Check that everything can be written, before the work; makes the folder if there is none.
   * \throws pcl::cosection::IoError */
  explicit OutputTarget (const Settings& settings);

  /** \brief Removes the folder again if it was made here and nothing was written into it. */
  ~OutputTarget ();
  OutputTarget (const OutputTarget&) = delete;
  OutputTarget&
  operator= (const OutputTarget&) = delete;

  /** \brief Write what succeeded. \return the files, in the order written
   * \throws pcl::cosection::IoError */
  std::vector<std::string>
  write (const pcl::cosection::SceneResult& result) const;

private:
  std::string
  objectPath (const pcl::cosection::ObjectResult& object, const std::string& extension, bool only,
              const std::string& suffix = "") const;

  const std::string output_;
  const std::string format_;
  const bool save_sdf_;
  const bool single_file_;
  bool made_folder_ = false;
};
