// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/triangle_distance.h"

#include <Eigen/Geometry>

#include <cmath>

namespace pcl::cosection::test {

/** \brief Signed distance to a closed mesh from all its triangles; the sign by the solid angle. */
inline double
bruteForceDistance (const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double solid_angle = 0.0;
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double> ();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double> ();
    const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double> ();
    // Girard: the angle of the spherical triangle onto which this one projects is its excess over pi.
    const Eigen::Vector3d u = (a - p).normalized (), v = (b - p).normalized (), w = (c - p).normalized ();
    const auto corner = [] (const Eigen::Vector3d& at, const Eigen::Vector3d& s, const Eigen::Vector3d& t) {
      const Eigen::Vector3d x = at.cross (s), y = at.cross (t);
      return std::atan2 (x.cross (y).norm (), x.dot (y));
    };
    const double excess = corner (u, v, w) + corner (v, w, u) + corner (w, u, v) - M_PI;
    solid_angle += ((b - a).cross (c - a).dot (a - p) > 0.0 ? excess : -excess);
  }
  const double distance = bruteForceSurfaceDistance (mesh, p);
  return solid_angle > 2.0 * M_PI ? -distance : distance;
}

} // namespace pcl::cosection::test
