// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

/** \brief The corners of a triangle as columns. */
inline Eigen::Matrix3d
cornersOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  Eigen::Matrix3d corners;
  for (int n = 0; n < 3; ++n)
    corners.col (n) = mesh.vertices[triangle[n]].cast<double> ();
  return corners;
}

/** \brief Outward normal of a triangle, with twice its area as length. */
inline Eigen::Vector3d
areaVectorOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  const Eigen::Matrix3d corners = cornersOf (mesh, triangle);
  return (corners.col (1) - corners.col (0)).cross (corners.col (2) - corners.col (0));
}

/** \brief Quality of a triangle; 1: equilateral, 0: degenerate. */
inline double
qualityOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  const Eigen::Matrix3d c = cornersOf (mesh, triangle);
  const double sides = (c.col (1) - c.col (0)).squaredNorm () + (c.col (2) - c.col (1)).squaredNorm () +
                       (c.col (0) - c.col (2)).squaredNorm ();
  return sides > 0.0 ? 2.0 * std::sqrt (3.0) * areaVectorOf (mesh, triangle).norm () / sides : 0.0;
}

/** \brief The mesh with every triangle split into four, repeated \a times. */
inline TriangleMesh
subdivided (TriangleMesh mesh, int times)
{
  for (; times > 0; --times)
  {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&] (std::uint32_t a, std::uint32_t b) {
      const auto next = static_cast<std::uint32_t> (mesh.vertices.size ());
      const auto found = middles.insert ({{std::min (a, b), std::max (a, b)}, next});
      if (found.second)
        mesh.vertices.push_back (0.5f * (mesh.vertices[a] + mesh.vertices[b]));
      return found.first->second;
    };
    std::vector<TriangleMesh::Triangle> triangles;
    for (const auto& t : mesh.triangles)
    {
      const std::uint32_t ab = middle (t[0], t[1]);
      const std::uint32_t bc = middle (t[1], t[2]);
      const std::uint32_t ca = middle (t[2], t[0]);
      triangles.insert (triangles.end (), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move (triangles);
  }
  return mesh;
}

/** \brief Euler characteristics of the components, ascending. */
inline std::vector<int>
eulerOfComponents (const TriangleMesh& mesh)
{
  const std::vector<int> labels = labelComponents (mesh);
  std::vector<int> euler;
  for (int label = 0; label <= *std::max_element (labels.begin (), labels.end ()); ++label)
  {
    std::vector<bool> keep;
    for (const auto& triangle : mesh.triangles)
      keep.push_back (labels[triangle[0]] == label);
    if (std::find (keep.begin (), keep.end (), true) != keep.end ())
      euler.push_back (computeTopology (extractTriangles (mesh, keep)).euler);
  }
  std::sort (euler.begin (), euler.end ());
  return euler;
}

/** \brief Expect two manifolds, both closed or both open, whose components have the same Euler characteristics. */
inline void
expectSameTopology (const TriangleMesh& a, const TriangleMesh& b)
{
  const MeshTopology of_a = computeTopology (a);
  const MeshTopology of_b = computeTopology (b);
  EXPECT_EQ (of_a.non_manifold_edges, 0);
  EXPECT_EQ (of_a.non_manifold_vertices, 0);
  EXPECT_EQ (of_a.closed_manifold, of_b.closed_manifold);
  EXPECT_EQ (of_a.components, of_b.components);
  EXPECT_EQ (eulerOfComponents (a), eulerOfComponents (b));
}

} // namespace pcl::cosection::test
