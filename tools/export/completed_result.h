// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/scene_builder.h"

#include <Eigen/Core>

#include <string>
#include <vector>

/** \brief What pcl_cosection or pcl_cosection_fusion wrote. */
struct CompletedResult
{
  pcl::cosection::CompletedScene scene;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< of the scene's frame in that of the files
  std::vector<std::string> files;                    ///< that were read
  std::vector<std::string> warnings;
};

/** \brief Read a folder of one of both programs: its summary.json, meshes, and the last poses of trajectories.
 * \throws pcl::cosection::IoError naming the file and what is wrong with it */
CompletedResult readCompletedResult (const std::string& folder);
