// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection::test {

inline std::vector<OrientedPoint>
moved (std::vector<OrientedPoint> points, const Eigen::Isometry3d& T)
{
  for (OrientedPoint& p : points)
  {
    p.position = (T * p.position.cast<double> ()).cast<float> ();
    p.normal = (T.linear () * p.normal.cast<double> ()).cast<float> ();
  }
  return points;
}

} // namespace pcl::cosection::test
