// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection::test {

inline double
distanceToSegment (const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm ();
  const double t = length2 > 0.0 ? std::clamp (ab.dot (p - a) / length2, 0.0, 1.0) : 0.0;
  return ((p - a - t * ab).norm ());
}

/** \brief Exact distance of a point to a triangle, which may have no area: that to its plane if the point is above it,
 * else the least to its sides. */
inline double
distanceToTriangle (const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector3d& c)
{
  const Eigen::Vector3d normal = (b - a).cross (c - a);
  const double length = normal.norm ();
  const bool above = length > 0.0 && normal.dot ((b - a).cross (p - a)) >= 0.0 &&
                     normal.dot ((c - b).cross (p - b)) >= 0.0 && normal.dot ((a - c).cross (p - c)) >= 0.0;
  if (above)
    return (std::abs (normal.dot (p - a)) / length);
  return (std::min ({distanceToSegment (p, a, b), distanceToSegment (p, b, c), distanceToSegment (p, c, a)}));
}

/** \brief The least distance of a point to the triangles of a mesh; infinite for an empty one. */
inline double
bruteForceSurfaceDistance (const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double least = std::numeric_limits<double>::infinity ();
  for (const auto& [a, b, c] : mesh.triangles)
    least = std::min (least, distanceToTriangle (p, mesh.vertices[a].cast<double> (), mesh.vertices[b].cast<double> (),
                                                 mesh.vertices[c].cast<double> ()));
  return (least);
}

} // namespace pcl::cosection::test
