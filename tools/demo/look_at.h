// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Geometry>

/** \brief Pose (T_world_camera) of a camera at \a eye that looks at \a target; the world's z axis points up in its
 * picture. \a eye must not lie straight above or below \a target. */
inline Eigen::Isometry3d
lookAt (const Eigen::Vector3d& eye, const Eigen::Vector3d& target)
{
  const Eigen::Vector3d forward = (target - eye).normalized ();
  const Eigen::Vector3d right = forward.cross (Eigen::Vector3d::UnitZ ()).normalized ();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () << right, forward.cross (right), forward;
  pose.translation () = eye;
  return (pose);
}
