// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_poses.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

#include <cmath>
#include <limits>
#include <numeric>

using namespace pcl::cosection;

namespace {

constexpr double same_view = 0.5; ///< largest difference of a stamp from the number of its view

} // namespace

ObjectPoses
readPoses (const std::map<int, std::string>& files, std::size_t views)
{
  Eigen::Isometry3d unknown;
  unknown.matrix ().setConstant (std::numeric_limits<double>::quiet_NaN ());
  ObjectPoses T_world_object;
  std::vector<double> numbers (views);
  std::iota (numbers.begin (), numbers.end (), 0.0);
  for (const auto& [label, file] : files)
  {
    std::vector<Eigen::Isometry3d>& poses = T_world_object[label];
    poses.assign (views, unknown);
    std::vector<double> nearest (views, same_view);
    bool any = false;
    for (const StampedPose& stamped : loadTrajectory (file, numbers))
    {
      const double view = std::round (stamped.stamp);
      if (!(view >= 0.0 && view < static_cast<double> (views)))
        continue;
      const auto v = static_cast<std::size_t> (view);
      const double difference = std::abs (stamped.stamp - view);
      if (difference >= nearest[v])
        continue;
      nearest[v] = difference;
      poses[v] = stamped.pose;
      any = true;
    }
    if (!any)
      throw IoError (file + ": has no pose for any of the " + std::to_string (views) +
                     " views; its stamps must be their numbers, 0 for the first INPUT");
  }
  return (T_world_object);
}

ObjectPoses
relativeTo (const Eigen::Vector3d& origin, ObjectPoses poses)
{
  for (auto& [label, T_world_object] : poses)
    for (Eigen::Isometry3d& pose : T_world_object)
      pose.translation () -= origin;
  return poses;
}

ObjectPoses
ofInputs (const std::vector<std::size_t>& inputs, const ObjectPoses& poses)
{
  ObjectPoses of_views;
  for (const auto& [label, T_world_object] : poses)
    for (const std::size_t input : inputs)
      of_views[label].push_back (T_world_object[input]);
  return of_views;
}

std::vector<Eigen::Isometry3d>
posesOf (const ObjectPoses& poses, std::uint32_t label)
{
  const auto found = poses.find (static_cast<int> (label));
  return (found == poses.end () ? std::vector<Eigen::Isometry3d> () : found->second);
}
