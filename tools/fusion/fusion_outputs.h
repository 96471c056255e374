// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fusion_command_line.h"

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/** \brief The folder that a run writes. Each file is whole or not there. */
class FusionOutputs
{
public:
  /** \brief Nothing is touched yet. Keeps a reference.
   * \throws UsageError if an input would be overwritten \throws pcl::cosection::IoError if OUTPUT is a file, or the
   * further summary cannot be written */
  explicit FusionOutputs (const FusionSettings& settings);

  /** \brief Make the folder, if there is none, and remove what an earlier run wrote into it. Other files stay.
   * \throws pcl::cosection::IoError if it cannot be written */
  void begin ();

  /** \brief Write the meshes of a keyframe. \throws pcl::cosection::IoError */
  void writeKeyframe (const pcl::cosection::KeyframeReport& keyframe) const;

  /** \brief Write meshes and trajectories. \return the files \throws pcl::cosection::IoError */
  std::vector<std::string> write (const pcl::cosection::FusionResult& result) const;

  /** \brief Write summary.json. \throws pcl::cosection::IoError */
  void writeSummary (const pcl::cosection::FusionResult& result) const;

  /** \brief Write a summary of a run that failed as a whole; into the folder only if the run had begun. */
  void writeFailure (const std::string& error) const;

private:
  const FusionSettings& settings_;
  const std::filesystem::path folder_;
  bool begun_ = false;
};
