// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"

#include <pcl/cosection/surface/co_section.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/** \brief The files that a run writes.
 *
 * Symbolic links stay: the file or folder that one points to is written, and made if there is none. */
class OutputTarget
{
public:
  /** \brief Check that everything can be written, before the work; makes the folder if there is none
   * (and removes it again if nothing is written into it). Keeps a reference.
   * \throws UsageError if an input would be overwritten, or a mesh by the summary
   * \throws pcl::cosection::IoError */
  explicit OutputTarget (const Settings& settings);

  /** \brief Write what succeeded. \param[in] origin of the frame of the meshes, in the world \return the files, in the
   * order written
   * \throws pcl::cosection::IoError */
  std::vector<std::string> write (const pcl::cosection::SceneResult& result, const Eigen::Vector3d& origin) const;

  /** \brief Write the summary: summary.json beside meshes in a folder, and what --json asks for.
   * \throws pcl::cosection::IoError */
  void writeSummary (const nlohmann::ordered_json& summary) const;

  /** \brief The summary of an earlier run in the folder; empty if there is none. */
  std::string formerSummary () const;

private:
  /** \brief Whether a file of this name in the folder of the output may be written. */
  bool isOwnName (const std::filesystem::path& name) const;

  void refuseToOverwrite () const;

  /** \brief Remove the meshes and grids of an earlier run in the folder, which its summary no longer tells of. */
  void removeFormer (const std::vector<std::string>& written) const;

  std::string objectPath (const pcl::cosection::ObjectResult& object, const std::string& extension, bool only,
                          const std::string& suffix = "") const;

  std::string summaryPath () const; ///< of a folder

  const Settings& settings_;
  const bool single_file_;
  const std::shared_ptr<const class OutputFolder> folder_;
};
