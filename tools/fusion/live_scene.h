// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

/** \brief What there is to show of a run that goes on. */
struct LiveScene
{
  std::vector<pcl::cosection::StampedPose> camera;
  std::map<int, std::vector<pcl::cosection::StampedPose>> objects;
  std::map<int, pcl::cosection::TriangleMesh> seen, completed; ///< object frame
  std::deque<pcl::cosection::TriangleMesh> background;         ///< as keyframes see it, world frame
  std::set<int> changed_seen, changed_completed;               ///< since they were written
  bool changed_background = false;
};

/** \brief A mesh in the world of the background's pixels in a frame, at a stride. */
pcl::cosection::TriangleMesh backgroundOf (const pcl::cosection::FrameReport& report,
                                           const pcl::cosection::PinholeCamera& camera);

/** \brief Write what has changed, in the layout of a run; each file is whole. \throws pcl::cosection::IoError */
void writeLiveScene (const LiveScene& scene, const std::string& folder);
