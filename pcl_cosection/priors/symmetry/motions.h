// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

namespace pcl::cosection {

/** \brief Isometries, reflections among them, that may take an object to itself. */
using Motions = std::vector<Eigen::Affine3d>;

inline OrientedPoint
moved (OrientedPoint point, const Eigen::Affine3d& motion)
{
  point.position = (motion * point.position.cast<double> ()).cast<float> ();
  point.normal = (motion.linear () * point.normal.cast<double> ()).cast<float> ();
  return point;
}

/** \brief The reflection in the plane n.x = d, unit n. */
inline Eigen::Affine3d
reflection (const Eigen::Vector3d& n, double d)
{
  Eigen::Affine3d motion = Eigen::Affine3d::Identity ();
  motion.linear () -= 2.0 * n * n.transpose ();
  motion.translation () = 2.0 * d * n;
  return motion;
}

/** \brief The rotation by \a angle (radians) about the axis through \a center along the unit vector \a axis. */
inline Eigen::Affine3d
rotation (const Eigen::Vector3d& center, const Eigen::Vector3d& axis, double angle)
{
  Eigen::Affine3d motion = Eigen::Affine3d::Identity ();
  motion.linear () = Eigen::AngleAxisd (angle, axis).toRotationMatrix ();
  motion.translation () = center - motion.linear () * center;
  return motion;
}

/** \brief The rotations about an axis by the multiples of a \a count th of a full turn, without the identity. */
inline Motions
turns (const Eigen::Vector3d& center, const Eigen::Vector3d& axis, int count)
{
  Motions motions;
  for (int k = 1; k < count; ++k)
    motions.push_back (rotation (center, axis, 2.0 * M_PI * k / count));
  return motions;
}

} // namespace pcl::cosection
