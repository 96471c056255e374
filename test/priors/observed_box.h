// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection::test {

/** \brief The support plane z = 0. */
inline const Eigen::Vector4d ground (0.0, 0.0, 1.0, 0.0);

/** \brief Points every \a spacing_m on those faces of a box about the origin that a camera in the direction \a
 * seen_from sees. */
inline std::vector<OrientedPoint>
observedBox (const Eigen::Vector3d& half_size, const Eigen::Vector3d& seen_from, double spacing_m = 0.002)
{
  std::vector<OrientedPoint> points;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (seen_from[axis] == 0.0)
      continue;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double side = seen_from[axis] > 0.0 ? 1.0 : -1.0;
    for (double a = -half_size[u]; a <= half_size[u] + 1e-9; a += spacing_m)
      for (double b = -half_size[v]; b <= half_size[v] + 1e-9; b += spacing_m)
      {
        Eigen::Vector3d p;
        p[axis] = side * half_size[axis];
        p[u] = a;
        p[v] = b;
        OrientedPoint point;
        point.position = p.cast<float> ();
        point.normal = (side * Eigen::Vector3d::Unit (axis)).cast<float> ();
        points.push_back (point);
      }
  }
  return points;
}

} // namespace pcl::cosection::test
