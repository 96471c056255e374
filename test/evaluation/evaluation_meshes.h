// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/small_meshes.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl::cosection::test {

/** \brief A square of n x n cells of edge \a size from the origin, at height \a z, facing up. */
inline TriangleMesh
planeMesh (double size, std::uint32_t n, double z = 0.0)
{
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back (Eigen::Vector3d (size * i / n, size * j / n, z).cast<float> ());
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i)
    {
      const std::uint32_t a = j * (n + 1) + i;
      mesh.triangles.push_back ({a, a + 1, a + n + 2});
      mesh.triangles.push_back ({a, a + n + 2, a + n + 1});
    }
  return mesh;
}

/** \brief The triangles of a mesh whose corners are all at z >= 0. */
inline TriangleMesh
upperPart (const TriangleMesh& mesh)
{
  constexpr float rounding = 1e-6f;
  std::vector<bool> keep;
  for (const auto& t : mesh.triangles)
    keep.push_back (
        std::all_of (t.begin (), t.end (), [&] (std::uint32_t v) { return mesh.vertices[v].z () > -rounding; }));
  return extractTriangles (mesh, keep);
}

/** \brief Distance of a point to a triangle by Voronoi regions (C. Ericson, "Real-Time Collision Detection", 5.1.5):
 * another way than the one under test. */
inline double
triangleDistance (const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c)
{
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot (ap), d2 = ac.dot (ap), d3 = ab.dot (bp), d4 = ac.dot (bp), d5 = ab.dot (cp),
               d6 = ac.dot (cp);
  if (d1 <= 0.0 && d2 <= 0.0)
    return ap.norm ();
  if (d3 >= 0.0 && d4 <= d3)
    return bp.norm ();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
    return (p - (a + d1 / (d1 - d3) * ab)).norm ();
  if (d6 >= 0.0 && d5 <= d6)
    return cp.norm ();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
    return (p - (a + d2 / (d2 - d6) * ac)).norm ();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return (p - (b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b))).norm ();
  const double denominator = 1.0 / (va + vb + vc);
  return (p - (a + ab * vb * denominator + ac * vc * denominator)).norm ();
}

inline double
bruteForceSurfaceDistance (const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double least = std::numeric_limits<double>::infinity ();
  for (const auto& t : mesh.triangles)
    least = std::min (least,
                      triangleDistance (p, mesh.vertices[t[0]].cast<double> (), mesh.vertices[t[1]].cast<double> (),
                                        mesh.vertices[t[2]].cast<double> ()));
  return least;
}

/** \brief Turned by \a angle about \a axis, then moved. */
inline Eigen::Isometry3d
motion (double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = Eigen::AngleAxisd (angle, axis.normalized ()).toRotationMatrix ();
  pose.translation () = translation;
  return pose;
}

} // namespace pcl::cosection::test
