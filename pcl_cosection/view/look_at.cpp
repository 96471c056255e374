// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "look_at.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {

Eigen::Isometry3d
lookAt (const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up)
{
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero ();
  axes.col (2) = target - eye;
  if (!(axes.col (2).allFinite () && axes.col (2).norm () > 1e-9))
    throw InvalidArgument ("look_at is where the camera is");
  if (!(up.allFinite () && up.norm () > 1e-9))
    throw InvalidArgument ("up must be a direction");
  axes.col (2).normalize ();
  axes.col (0) = axes.col (2).cross (up.stableNormalized ());
  if (!(axes.col (0).norm () > 1e-6)) // straight up or down
    axes.col (0) = axes.col (2).unitOrthogonal ();
  axes.col (0).normalize ();
  axes.col (1) = axes.col (2).cross (axes.col (0));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = axes;
  pose.translation () = eye;
  return pose;
}

Eigen::Isometry3d
lookingAlong (const Eigen::Vector3d& eye, const Eigen::Vector3d& axis)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = Eigen::Quaterniond::FromTwoVectors (Eigen::Vector3d::UnitZ (), axis).toRotationMatrix ();
  pose.translation () = eye;
  return pose;
}

} // namespace pcl::cosection
