// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "analytic_fields.h"
#include "brute_force_distance.h"
#include "common/small_meshes.h"

#include <pcl/cosection/volume/mesh_distance.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

inline VoxelGrid
cubicGrid (const Eigen::Vector3d& centre, int dim, double voxel_size_m)
{
  VoxelGrid grid;
  grid.dims.setConstant (dim);
  grid.voxel_size_m = voxel_size_m;
  grid.origin_m = centre.array () - 0.5 * voxel_size_m * (dim - 1);
  return grid;
}

template <typename Visit>
inline void
forEachVoxel (const SignedDistanceField& field, Visit&& visit)
{
  for (int k = 0; k < field.grid.dims.z (); ++k)
    for (int j = 0; j < field.grid.dims.y (); ++j)
      for (int i = 0; i < field.grid.dims.x (); ++i)
        visit (field.grid.center (i, j, k), field.grid.index (i, j, k));
}

/** \brief Expect that every value agrees with \a truth, clamped to the band, and that every voxel is supported. */
inline void
expectField (const SignedDistanceField& field, const Distance& truth, double band_m, double tolerance_m)
{
  EXPECT_TRUE (field.supported.empty ());
  ASSERT_EQ (field.values.size (), field.grid.size ());
  double worst = 0.0;
  Eigen::Vector3d where = Eigen::Vector3d::Zero ();
  forEachVoxel (field, [&] (const Eigen::Vector3d& p, std::size_t n) {
    const double error = std::abs (field.values[n] - std::clamp (truth (p), -band_m, band_m));
    if (!(error <= worst))
    {
      worst = error;
      where = p;
    }
  });
  EXPECT_LE (worst, tolerance_m) << "at " << where.transpose () << ", where the truth is " << truth (where);
}

inline void
expectBruteForce (const TriangleMesh& mesh, const VoxelGrid& grid, double band_m)
{
  expectField (
      sampleSignedDistance (mesh, grid, band_m),
      [&] (const Eigen::Vector3d& p) { return bruteForceDistance (mesh, p); }, band_m, 1e-6);
}

inline TriangleMesh
transformed (TriangleMesh mesh, const Eigen::Isometry3d& T)
{
  for (auto& v : mesh.vertices)
    v = (T * v.cast<double> ()).cast<float> ();
  mesh.normals.clear ();
  return mesh;
}

inline Eigen::Isometry3d
oblique ()
{
  return Eigen::Translation3d (0.013, -0.021, 0.008) *
         Eigen::AngleAxisd (0.7, Eigen::Vector3d (1.0, 2.0, -0.5).normalized ());
}

inline TriangleMesh
flipped (TriangleMesh mesh)
{
  for (auto& triangle : mesh.triangles)
    std::swap (triangle[0], triangle[1]);
  return mesh;
}

inline TriangleMesh
united (TriangleMesh mesh, const TriangleMesh& other)
{
  appendMesh (mesh, other);
  return mesh;
}

/** \brief The mesh with three own vertices for every triangle. */
inline TriangleMesh
soup (const TriangleMesh& mesh)
{
  TriangleMesh result;
  for (const auto& triangle : mesh.triangles)
  {
    const auto first = static_cast<std::uint32_t> (result.vertices.size ());
    for (const auto v : triangle)
      result.vertices.push_back (mesh.vertices[v]);
    result.triangles.push_back ({first, first + 1, first + 2});
  }
  return result;
}

/** \brief The mesh with \a count new vertices on one side of a triangle; this triangle and its neighbour are divided
 * accordingly. */
inline TriangleMesh
withDividedEdge (TriangleMesh mesh, std::size_t triangle, std::uint32_t count)
{
  const std::uint32_t a = mesh.triangles[triangle][0], b = mesh.triangles[triangle][1];
  const auto first = static_cast<std::uint32_t> (mesh.vertices.size ());
  const auto at = [&] (std::uint32_t n) { return n == 0 ? a : n > count ? b : first + n - 1; };
  for (std::uint32_t n = 1; n <= count; ++n)
  {
    const float t = static_cast<float> (n) / static_cast<float> (count + 1);
    mesh.vertices.push_back ((1.0f - t) * mesh.vertices[a] + t * mesh.vertices[b]);
  }
  for (std::size_t k = 0, size = mesh.triangles.size (); k < size; ++k)
    for (int n = 0; n < 3; ++n)
    {
      const TriangleMesh::Triangle corners = mesh.triangles[k];
      const std::uint32_t from = corners[n], to = corners[(n + 1) % 3], opposite = corners[(n + 2) % 3];
      if (!(from == a && to == b) && !(from == b && to == a))
        continue;
      for (std::uint32_t m = 0; m <= count; ++m)
      {
        TriangleMesh::Triangle part = {at (m), at (m + 1), opposite};
        if (from == b)
          std::swap (part[0], part[1]);
        if (m == 0)
          mesh.triangles[k] = part;
        else
          mesh.triangles.push_back (part);
      }
      break;
    }
  mesh.normals.clear ();
  return mesh;
}

/** \brief A quadrilateral of two triangles that faces where its corners are counter-clockwise. */
inline TriangleMesh
quad (const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, const Eigen::Vector3f& d)
{
  TriangleMesh mesh;
  mesh.vertices = {a, b, c, d};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/** \brief The square |x|, |y| <= half of the plane z = 0, which faces up. */
inline TriangleMesh
square (float half)
{
  return quad ({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0});
}

/** \brief The walls and the floor of a box, facing its inside; no lid. */
inline TriangleMesh
bin (const Eigen::Vector3f& half)
{
  TriangleMesh mesh = flipped (boxMesh (-half, half));
  std::vector<bool> keep (mesh.triangles.size (), true);
  keep[2] = keep[3] = false; // at the upper end of z
  return extractTriangles (mesh, keep);
}

/** \brief A bent bar whose two sharp ends meet in the origin, where the surface is not a manifold. */
inline TriangleMesh
horseshoe ()
{
  const std::vector<Eigen::Vector2d> path = {{0.0, 0.0},   {0.1, 0.05},  {0.2, 0.07}, {0.26, 0.0},
                                             {0.2, -0.07}, {0.1, -0.05}, {0.0, 0.0}};
  const double radius = 0.02;
  TriangleMesh mesh;
  mesh.vertices.emplace_back (0.0f, 0.0f, 0.0f);
  const auto at = [] (std::size_t section, int corner) {
    return static_cast<std::uint32_t> (3 * section - 2 + corner % 3);
  };
  for (std::size_t n = 1; n + 1 < path.size (); ++n)
  {
    const Eigen::Vector2d along = (path[n + 1] - path[n - 1]).normalized ();
    for (int corner = 0; corner < 3; ++corner)
    {
      const double a = 2.0 * M_PI * corner / 3.0;
      const Eigen::Vector3d across (-along.y () * std::cos (a), along.x () * std::cos (a), std::sin (a));
      mesh.vertices.push_back ((Eigen::Vector3d (path[n].x (), path[n].y (), 0.0) + radius * across).cast<float> ());
      const auto next = at (n, corner + 1);
      if (n == 1)
        mesh.triangles.push_back ({0, next, at (n, corner)});
      if (n + 2 == path.size ())
        mesh.triangles.push_back ({0, at (n, corner), next});
      else
      {
        mesh.triangles.push_back ({at (n, corner), next, at (n + 1, corner)});
        mesh.triangles.push_back ({next, at (n + 1, corner + 1), at (n + 1, corner)});
      }
    }
  }
  return mesh;
}

} // namespace pcl::cosection::test
