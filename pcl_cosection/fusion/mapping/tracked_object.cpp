// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tracked_object.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl::cosection {

void
ClassEvidence::add (const ClassScore& detection)
{
  if (!(detection.score >= 0.0 && detection.score <= 1.0))
    throw InvalidArgument ("the score of a detection must be in [0, 1]; it is " + std::to_string (detection.score));
  sums_.try_emplace (detection.class_id, ClassScore{detection.class_id, detection.class_name, 0.0})
      .first->second.score += detection.score;
  ++detections_;
}

void
ClassEvidence::add (const ClassEvidence& other)
{
  for (const auto& [class_id, sum] : other.sums_)
    sums_.try_emplace (class_id, ClassScore{class_id, sum.class_name, 0.0}).first->second.score += sum.score;
  detections_ += other.detections_;
}

std::optional<ClassScore>
ClassEvidence::best () const
{
  if (detections_ == 0)
    return std::nullopt;
  ClassScore best = std::max_element (sums_.begin (), sums_.end (), [] (const auto& a, const auto& b) {
                      return a.second.score < b.second.score;
                    })->second;
  best.score /= static_cast<double> (detections_);
  return best;
}

void
TrackedObject::moveTo (const Eigen::Isometry3d& T_world)
{
  const VoxelGrid& grid = volume->grid ();
  const Eigen::Vector3d centre = grid.origin_m + 0.5 * grid.voxel_size_m * grid.dims.cast<double> ();
  constexpr double surface_share = 0.2; // of a volume's side: how far an object's surface is from its centre
  const double radius = surface_share * grid.voxel_size_m * grid.dims.maxCoeff ();
  const double turn = Eigen::AngleAxisd (T_world.linear ().transpose () * T_world_rest.linear ()).angle ();
  const double moved = std::max ((T_world * centre - T_world_rest * centre).norm (), radius * turn);
  ++frames_at_rest;
  frames_away = moved > std::hypot (grid.voxel_size_m, depthNoiseSigma (range_m)) ? frames_away + 1 : 0;
  if (frames_away >= frames_of_motion)
  {
    T_world_rest = T_world;
    frames_at_rest = 0;
  }
  T_world_object = T_world;
}

} // namespace pcl::cosection
