// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_poses.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

constexpr double same_view = 0.5; ///< largest difference of a stamp from the number of its view

Eigen::Isometry3d
unknownPose ()
{
  Eigen::Isometry3d pose;
  pose.matrix ().setConstant (std::numeric_limits<double>::quiet_NaN ());
  return (pose);
}

} // namespace

ObjectPoses::ObjectPoses (const std::map<int, std::string>& files, std::size_t views) : files_ (files)
{
  for (const auto& [label, file] : files)
  {
    std::vector<Eigen::Isometry3d>& poses = T_world_object_[label];
    poses.assign (views, unknownPose ());
    std::vector<double> nearest (views, same_view);
    bool any = false;
    for (const StampedPose& stamped : loadTrajectory (file))
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
}

const std::vector<Eigen::Isometry3d>&
ObjectPoses::of (int label) const
{
  static const std::vector<Eigen::Isometry3d> none;
  const auto poses = T_world_object_.find (label);
  return (poses == T_world_object_.end () ? none : poses->second);
}

std::vector<std::string>
ObjectPoses::unused (const std::vector<int>& labels) const
{
  std::vector<std::string> warnings;
  for (const auto& [label, file] : files_)
    if (std::find (labels.begin (), labels.end (), label) == labels.end ())
      warnings.push_back (file + ": is not used, there is no object " + std::to_string (label));
  return (warnings);
}
