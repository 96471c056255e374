// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection::test {

inline double
segmentDistance (const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const double t = std::clamp ((p - a).dot (b - a) / (b - a).squaredNorm (), 0.0, 1.0);
  return (p - a - t * (b - a)).norm ();
}

/** \brief Signed distance to a closed mesh from all its triangles: the distance to the plane where the
 * projection has positive barycentric coordinates, else to the border, and the sign by the solid angle. */
inline double
bruteForceDistance (const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double distance = std::numeric_limits<double>::infinity ();
  double solid_angle = 0.0;
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double> ();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double> ();
    const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double> ();
    Eigen::Matrix3d frame;
    frame << b - a, c - a, (b - a).cross (c - a).normalized ();
    const Eigen::Vector3d local = frame.inverse () * (p - a);
    if (local.x () >= 0.0 && local.y () >= 0.0 && local.x () + local.y () <= 1.0)
      distance = std::min (distance, std::abs (local.z ()));
    distance = std::min ({distance, segmentDistance (p, a, b), segmentDistance (p, b, c), segmentDistance (p, c, a)});

    // Girard: the angle of the spherical triangle onto which this one projects is its excess over pi.
    const Eigen::Vector3d u = (a - p).normalized (), v = (b - p).normalized (), w = (c - p).normalized ();
    const auto corner = [] (const Eigen::Vector3d& at, const Eigen::Vector3d& s, const Eigen::Vector3d& t) {
      const Eigen::Vector3d x = at.cross (s), y = at.cross (t);
      return std::atan2 (x.cross (y).norm (), x.dot (y));
    };
    const double excess = corner (u, v, w) + corner (v, w, u) + corner (w, u, v) - M_PI;
    solid_angle += (frame.col (2).dot (a - p) > 0.0 ? excess : -excess);
  }
  return solid_angle > 2.0 * M_PI ? -distance : distance;
}

} // namespace pcl::cosection::test
