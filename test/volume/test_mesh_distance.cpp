// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "distance_meshes.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace pcl::cosection;
using test::cubicGrid;
using test::expectBruteForce;
using test::expectField;
using test::flipped;
using test::horseshoe;
using test::oblique;
using test::soup;
using test::square;
using test::transformed;
using test::united;

TEST (MeshDistance, AgreesWithASphere)
{
  const double radius = 0.1;
  const std::uint32_t n = 32;
  const double sagitta = radius * (1.0 - std::pow (std::cos (0.5 * M_PI / n), 2));
  const TriangleMesh mesh = test::sphereMesh (radius, n);
  for (const double voxel_size : {0.005, 0.02})
    for (const double band : {0.015, 1.0})
      expectField (sampleSignedDistance (mesh, cubicGrid ({0.01, 0, 0}, 26, voxel_size), band), test::sphere (radius),
                   band, sagitta);
}

TEST (MeshDistance, AgreesWithATorus)
{
  const TriangleMesh mesh = test::torusMesh (0.1, 0.04, 96, 48);
  expectField (sampleSignedDistance (mesh, cubicGrid ({0, 0, 0}, 40, 0.008), 0.05), test::torus (0.1, 0.04), 0.05,
               2e-4);
}

TEST (MeshDistance, IsExactForABoxWhereverTheGridIs)
{
  const Eigen::Vector3f half (0.1f, 0.06f, 0.25f);
  const TriangleMesh mesh = test::boxMesh (-half, half);
  const auto truth = test::box (half.cast<double> ());
  const double band = 0.03;
  for (const Eigen::Vector3d& centre : {Eigen::Vector3d (0, 0, 0), Eigen::Vector3d (0.1, 0.06, 0.25), // the corner
                                        Eigen::Vector3d (0.1, 0, 0), Eigen::Vector3d (0, 0, 0.1),
                                        Eigen::Vector3d (0.5, 0.4, 0.3), Eigen::Vector3d (-30, 20, 1000)})
    for (const double voxel_size : {0.0007, 0.011, 0.2})
      expectField (sampleSignedDistance (mesh, cubicGrid (centre, 13, voxel_size), band), truth, band, 1e-6);
  // Deep inside, out of sight of any triangle; and single voxels.
  const TriangleMesh large = test::boxMesh ({-5, -5, -5}, {5, 5, 5});
  for (const float value : sampleSignedDistance (large, cubicGrid ({1, 1, 1}, 20, 0.01), 0.02).values)
    ASSERT_EQ (value, -0.02f);
  EXPECT_EQ (sampleSignedDistance (large, cubicGrid ({0, 0, 0}, 1, 0.01), 0.02).values[0], -0.02f);
  EXPECT_EQ (sampleSignedDistance (large, cubicGrid ({9, 0, 0}, 1, 0.01), 0.02).values[0], 0.02f);
}

TEST (MeshDistance, EqualsBruteForceOnRandomBumps)
{
  std::mt19937 random (7);
  std::uniform_real_distribution<double> factor (0.5, 1.5);
  for (int trial = 0; trial < 3; ++trial)
  {
    TriangleMesh mesh = test::sphereMesh (0.1, 6); // star-shaped, with saddles and spikes
    for (auto& v : mesh.vertices)
      v *= static_cast<float> (factor (random));
    expectBruteForce (transformed (mesh, oblique ()), cubicGrid ({0, 0, 0}, 16, 0.02), 0.04);
    // Many narrow triangles at some vertices are the same surface, with the same signs.
    for (int n = 0; n < 12; ++n)
      mesh = test::withDividedEdge (mesh, random () % mesh.triangles.size (), 10);
    ASSERT_TRUE (computeTopology (mesh).closed_manifold);
    expectBruteForce (transformed (mesh, oblique ()), cubicGrid ({0, 0, 0}, 16, 0.02), 0.1);
  }
}

TEST (MeshDistance, HasTheRightSignAtSharpEdgesVerticesAndSaddles)
{
  // A wedge of about one degree, seen from all around; its tip is an edge, with two vertices at the ends.
  TriangleMesh wedge;
  wedge.vertices = {{0, 0, 0},          {0, 0.1f, 0},         {0.2f, 0, 0.002f}, {0.2f, 0.1f, 0.002f},
                    {0.2f, 0, -0.002f}, {0.2f, 0.1f, -0.002f}};
  wedge.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {2, 4, 3}, {3, 4, 5}, {0, 4, 2}, {1, 3, 5}};
  ASSERT_TRUE (computeTopology (wedge).closed_manifold);
  // Few quadrilaterals: the vertices on the inner side of the ring are sharp saddles.
  const TriangleMesh ring = test::torusMesh (0.1, 0.06, 5, 3);
  for (const TriangleMesh& mesh : {wedge, ring, test::sphereMesh (0.1, 2)})
    for (const auto& T : {Eigen::Isometry3d::Identity (), oblique ()})
      for (const auto v : {0, 2, 4})
        expectBruteForce (transformed (mesh, T), cubicGrid (T * mesh.vertices[v].cast<double> (), 14, 0.011), 0.05);
}

TEST (MeshDistance, TakesEqualVerticesAsOne)
{
  const TriangleMesh mesh = test::torusMesh (0.1, 0.06, 7, 5);
  const VoxelGrid grid = cubicGrid ({0, 0, 0}, 20, 0.02);
  const auto field = sampleSignedDistance (soup (mesh), grid, 0.05);
  EXPECT_EQ (field.values, sampleSignedDistance (mesh, grid, 0.05).values);
  EXPECT_TRUE (field.supported.empty ());
}

TEST (MeshDistance, TrianglesWithoutAreaLeaveNoGap)
{
  // A box whose upper front edge has a vertex in the middle on one side only; a flat triangle closes the gap.
  TriangleMesh mesh = test::boxMesh ({0, 0, 0}, {0.25f, 0.25f, 0.25f});
  mesh.vertices.emplace_back (0.125f, 0.0f, 0.25f); // 8, between 4 and 5
  mesh.triangles[5] = {1, 5, 8};                    // was {1, 5, 4}
  mesh.triangles.push_back ({1, 8, 4});
  mesh.triangles.push_back ({4, 8, 5});
  ASSERT_TRUE (computeTopology (mesh).closed_manifold);
  const auto truth = test::box ({0.125, 0.125, 0.125});
  expectField (
      sampleSignedDistance (mesh, cubicGrid ({0.125, 0.125, 0.125}, 25, 0.013), 0.1),
      [&] (const Eigen::Vector3d& p) { return truth (p - Eigen::Vector3d::Constant (0.125)); }, 0.1, 1e-6);
}

TEST (MeshDistance, OverlappingBodiesAreTheirUnion)
{
  const Eigen::Vector3d half (0.1, 0.1, 0.1);
  const auto box = test::box (half);
  const auto at = [&] (double x) {
    return test::boxMesh ({float (x) - 0.1f, -0.1f, -0.1f}, {float (x) + 0.1f, 0.1f, 0.1f});
  };
  for (const double shift : {0.05, 0.17, 0.35}) // nearly all, a bit, not at all
    expectField (
        sampleSignedDistance (united (at (0.0), at (shift)), cubicGrid ({0.1, 0, 0}, 25, 0.017), 0.06),
        [&] (const Eigen::Vector3d& p) { return std::min (box (p), box (p - Eigen::Vector3d (shift, 0, 0))); }, 0.06,
        1e-6);
  // Touching with a face of other triangles.
  TriangleMesh other = at (0.2);
  other.triangles[8] = {0, 4, 6}; // were {0, 4, 2} and {2, 4, 6}
  other.triangles[9] = {0, 6, 2};
  for (auto& v : other.vertices)
    v.x () = (v.x () < 0.2f ? 0.1f : 0.3f);
  expectField (
      sampleSignedDistance (united (at (0.0), other), cubicGrid ({0.1, 0, 0}, 25, 0.017), 0.06),
      [&] (const Eigen::Vector3d& p) { return std::min (box (p), box (p - Eigen::Vector3d (0.2, 0, 0))); }, 0.06, 1e-6);
  // Where two share a face, there is no surface between them.
  expectField (
      sampleSignedDistance (united (at (0.0), at (0.2)), cubicGrid ({0.1, 0, 0}, 25, 0.017), 0.06),
      [&] (const Eigen::Vector3d& p) {
        return test::box ({0.2, 0.1, 0.1}) (p - Eigen::Vector3d (0.1, 0, 0));
      },
      0.06, 1e-6);
}

TEST (MeshDistance, BodiesMayTouchAtAnEdgeOrAVertex)
{
  const auto box = test::box ({0.1, 0.1, 0.1});
  const TriangleMesh one = test::boxMesh ({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f});
  for (const Eigen::Vector3f& shift : {Eigen::Vector3f (0.2f, 0.2f, 0.0f), Eigen::Vector3f (0.2f, 0.2f, 0.2f)})
  {
    TriangleMesh two = one;
    for (auto& v : two.vertices)
      for (int axis = 0; axis < 3; ++axis) // the common corners are equal to the last bit
        v[axis] = (shift[axis] == 0.0f ? v[axis] : v[axis] < 0.0f ? 0.1f : 0.3f);
    expectField (
        sampleSignedDistance (united (one, two), cubicGrid ({0.1, 0.1, 0.05}, 25, 0.017), 0.06),
        [&] (const Eigen::Vector3d& p) { return std::min (box (p), box (p - shift.cast<double> ())); }, 0.06, 1e-6);
  }
}

TEST (MeshDistance, OneSurfaceMayTouchItself)
{
  const TriangleMesh mesh = horseshoe ();
  ASSERT_EQ (computeTopology (mesh).non_manifold_vertices, 1);
  ASSERT_EQ (computeTopology (mesh).boundary_edges, 0);
  ASSERT_GT (computeMassProperties (mesh).volume_m3, 0.0);
  for (const double voxel_size : {0.011, 0.002})
    expectBruteForce (mesh, cubicGrid ({0, 0, 0}, 25, voxel_size), 0.05);
}

TEST (MeshDistance, InwardPartsAreCavitiesOrRooms)
{
  const Eigen::Vector3f outer_half (0.2f, 0.2f, 0.2f), inner_half (0.1f, 0.12f, 0.08f);
  const TriangleMesh outer = test::boxMesh (-outer_half, outer_half);
  const TriangleMesh inner = flipped (test::boxMesh (-inner_half, inner_half));
  const auto outside = test::box (outer_half.cast<double> ());
  const auto cavity = test::box (inner_half.cast<double> ());
  const VoxelGrid grid = cubicGrid ({0.05, 0, 0}, 27, 0.019);
  expectField (
      sampleSignedDistance (united (inner, outer), grid, 0.3),
      [&] (const Eigen::Vector3d& p) { return std::max (outside (p), -cavity (p)); }, 0.3, 1e-6);
  expectField (
      sampleSignedDistance (inner, grid, 0.05), [&] (const Eigen::Vector3d& p) { return -cavity (p); }, 0.05, 1e-6);
}

TEST (MeshDistance, DoesNotDependOnTheNumberOfThreads)
{
  const TriangleMesh mesh = united (square (0.2f), transformed (test::torusMesh (0.1, 0.05, 24, 12), oblique ()));
  const VoxelGrid grid = cubicGrid ({0, 0, 0}, 48, 0.01);
  const auto one = sampleSignedDistance (mesh, grid, 0.05, 1);
  for (const int threads : {2, 3, 7})
  {
    const auto several = sampleSignedDistance (mesh, grid, 0.05, threads);
    EXPECT_EQ (one.values, several.values);
    EXPECT_EQ (one.supported, several.supported);
  }
}

TEST (MeshDistance, RefusesWhatHasNoDistance)
{
  const VoxelGrid grid = cubicGrid ({0, 0, 0}, 4, 0.1);
  const TriangleMesh mesh = square (0.1f);
  EXPECT_THROW (sampleSignedDistance (TriangleMesh (), grid, 0.1), InvalidArgument);
  EXPECT_THROW (sampleSignedDistance (united (mesh, flipped (mesh)), grid, 0.1), InvalidArgument); // back to back
  TriangleMesh line = mesh;
  line.vertices[2] = 0.5f * (line.vertices[0] + line.vertices[1]);
  line.triangles.resize (1);
  EXPECT_THROW (sampleSignedDistance (line, grid, 0.1), InvalidArgument);
  TriangleMesh broken = mesh;
  broken.triangles[0][0] = 4;
  EXPECT_THROW (sampleSignedDistance (broken, grid, 0.1), InvalidArgument);
  broken = mesh;
  broken.vertices[1].x () = std::numeric_limits<float>::quiet_NaN ();
  EXPECT_THROW (sampleSignedDistance (broken, grid, 0.1), InvalidArgument);
  broken = mesh;
  broken.vertices.emplace_back (std::numeric_limits<float>::quiet_NaN (), 0.0f, 0.0f); // not used
  EXPECT_NO_THROW (sampleSignedDistance (broken, grid, 0.1));
  for (const double band : {0.0, -1.0, std::numeric_limits<double>::infinity (), std::nan ("")})
    EXPECT_THROW (sampleSignedDistance (mesh, grid, band), InvalidArgument);
  EXPECT_THROW (sampleSignedDistance (mesh, VoxelGrid (), 0.1), InvalidArgument);
  VoxelGrid flat = grid;
  flat.voxel_size_m = 0.0;
  EXPECT_THROW (sampleSignedDistance (mesh, flat, 0.1), InvalidArgument);
}
