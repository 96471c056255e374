// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/small_meshes.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <algorithm>
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
