// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Points of things that are round about an axis, as a camera sees them.

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

/** \brief Distance from the axis, metres, and its derivative, at a height. */
using Profile = std::function<std::pair<double, double> (double)>;

inline std::pair<double, double>
can (double /*height*/)
{
  return {0.04, 0.0};
}

inline OrientedPoint
pointAt (const Eigen::Vector3d& position, const Eigen::Vector3d& normal)
{
  OrientedPoint point;
  point.position = position.cast<float> ();
  point.normal = normal.normalized ().cast<float> ();
  return point;
}

/** \brief Points of a surface of revolution about z that face a distant camera in direction \a view, whether or not
 * other parts hide them. */
inline std::vector<OrientedPoint>
observedRound (const Profile& profile, double bottom, double top, const Eigen::Vector3d& view, double side = 1.0)
{
  std::vector<OrientedPoint> points;
  for (double height = bottom; height <= top; height += 0.002)
  {
    const auto [radius, slope] = profile (height);
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.002 / std::max (0.002, radius))
    {
      const Eigen::Vector3d out (std::cos (angle), std::sin (angle), 0.0);
      const Eigen::Vector3d normal = side * Eigen::Vector3d (out.x (), out.y (), -slope).normalized ();
      if (normal.dot (view) > 0.1)
        points.push_back (pointAt (radius * out + height * Eigen::Vector3d::UnitZ (), normal));
    }
  }
  return points;
}

/** \brief The points with the noise of depth images: a millimetre in position, some degrees in normals. */
inline std::vector<OrientedPoint>
noisy (std::vector<OrientedPoint> points)
{
  std::mt19937 random (1);
  std::normal_distribution<float> normal;
  for (OrientedPoint& p : points)
  {
    p.position += 0.001f * normal (random) * p.normal;
    p.normal = (p.normal + 0.1f * Eigen::Vector3f (normal (random), normal (random), normal (random))).normalized ();
  }
  return points;
}

inline Eigen::Isometry3d
anyPose ()
{
  return Eigen::Translation3d (0.3, -0.2, 0.7) *
         Eigen::AngleAxisd (1.1, Eigen::Vector3d (1.0, 2.0, -1.0).normalized ());
}

/** \brief In how many of 36 directions around a frame's z axis there is a point at some height. */
inline int
sectorsOf (const std::vector<OrientedPoint>& points, const Eigen::Isometry3d& T, double lowest, double highest)
{
  std::vector<bool> seen (36, false);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = T.inverse () * point.position.cast<double> ();
    if (p.z () > lowest && p.z () < highest)
      seen[static_cast<std::size_t> (
          std::min (35.0, (std::atan2 (p.y (), p.x ()) / (2.0 * M_PI) + 0.5) * 36.0))] = true;
  }
  return static_cast<int> (std::count (seen.begin (), seen.end (), true));
}

} // namespace pcl::cosection::test
