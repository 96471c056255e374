// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Geometry>

namespace pcl
{
namespace cosection
{

/** \brief T_world_camera of a camera at \a eye that looks at \a target; \a up points up in its picture, and is not along the line of sight. */
inline Eigen::Isometry3d
poseLookingAt (const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up)
{
  const Eigen::Vector3d forward = (target - eye).normalized ();
  const Eigen::Vector3d right = forward.cross (up).normalized ();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () << right, forward.cross (right), forward;
  pose.translation () = eye;
  return pose;
}

} // namespace cosection
} // namespace pcl
