// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cmath>

namespace pcl::cosection {

/** \brief Normal, twice the area long, of the triangle at \a p, \a q, \a r. */
inline Eigen::Vector3d
areaVector (const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r)
{
  return (q - p).cross (r - p);
}

/** \brief That of a triangle of a mesh. */
inline Eigen::Vector3d
areaVector (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  const auto corner = [&] (int n) { return mesh.vertices[triangle[n]].cast<double> (); };
  return areaVector (corner (0), corner (1), corner (2));
}

/** \brief 4 sqrt (3) area / sum of squared sides of the triangle with that area vector: 1 for equilateral triangles,
 * exactly 0 for those that are lines or points but for rounding. */
inline double
triangleQuality (const Eigen::Vector3d& area_vector, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                 const Eigen::Vector3d& r)
{
  constexpr double rounding = 1e-6;
  const double sides = (q - p).squaredNorm () + (r - q).squaredNorm () + (p - r).squaredNorm ();
  const double scaled_area = 2.0 * std::sqrt (3.0) * area_vector.norm ();
  return scaled_area > rounding * sides ? scaled_area / sides : 0.0;
}

} // namespace pcl::cosection
