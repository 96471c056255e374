// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/triangle_distance.h"
#include "evaluation_meshes.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (SurfaceSamples, AreUniformByArea)
{
  // A large and a small square far apart, in triangles of very different sizes.
  TriangleMesh mesh = planeMesh (3.0, 1);
  appendMesh (mesh, planeMesh (1.0, 20, 10.0));
  constexpr std::size_t count = 40000;
  const auto points = sampleSurface (mesh, count, 7);
  ASSERT_EQ (points.size (), count);
  double small = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3d& p : points)
  {
    EXPECT_LT (bruteForceSurfaceDistance (mesh, p), 1e-6);
    if (p.z () > 5.0)
      small += 1.0;
    else
      sum += p;
  }
  EXPECT_NEAR (small / count, 0.1, 5.0 * std::sqrt (0.1 * 0.9 / count)); // five standard deviations
  const Eigen::Vector3d mean = sum / (count - small);
  EXPECT_NEAR (mean.x (), 1.5, 5.0 * 3.0 / std::sqrt (12.0 * count));
  EXPECT_NEAR (mean.y (), 1.5, 5.0 * 3.0 / std::sqrt (12.0 * count));
}

TEST (SurfaceSamples, FollowTheSeed)
{
  const TriangleMesh mesh = sphereMesh (1.0, 16);
  EXPECT_EQ (sampleSurface (mesh, 100, 1), sampleSurface (mesh, 100, 1));
  EXPECT_NE (sampleSurface (mesh, 100, 1), sampleSurface (mesh, 100, 2));
}

TEST (SurfaceSamples, AvoidTrianglesWithoutArea)
{
  TriangleMesh mesh = planeMesh (1.0, 1);
  mesh.vertices.emplace_back (50.0f, 50.0f, 50.0f);
  mesh.triangles.insert (mesh.triangles.begin (), {4, 4, 4});
  mesh.triangles.push_back ({4, 0, 4});
  for (const Eigen::Vector3d& p : sampleSurface (mesh, 1000))
    EXPECT_LT (p.norm (), 2.0);
}

TEST (SurfaceDistance, AgreesWithBruteForce)
{
  TriangleMesh mesh = torusMesh (0.1, 0.03, 24, 12);
  appendMesh (mesh, upperPart (sphereMesh (0.2, 10)));
  mesh.triangles.push_back ({0, 1, 1}); // without area
  std::vector<Eigen::Vector3d> points = sampleSurface (boxMesh ({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), 300);
  const auto near = sampleSurface (torusMesh (0.1, 0.035, 24, 12), 300);
  points.insert (points.end (), near.begin (), near.end ());
  const auto distances = SurfaceDistance (mesh).of (points);
  for (std::size_t n = 0; n < points.size (); ++n)
    EXPECT_NEAR (distances[n], bruteForceSurfaceDistance (mesh, points[n]), 1e-9);
}

TEST (MeshComparison, OfAMeshWithItselfIsPerfect)
{
  const TriangleMesh mesh = torusMesh (0.1, 0.03, 48, 24);
  const MeshComparison result = compareMeshes (mesh, mesh);
  EXPECT_LT (result.accuracy.max, 1e-8);
  EXPECT_LT (result.completeness.max, 1e-8);
  EXPECT_EQ (result.f_score, 1.0);
}

TEST (MeshComparison, OfShiftedPlanesIsTheShift)
{
  // All of the smaller one lies above the larger one.
  const TriangleMesh truth = planeMesh (2.0, 7);
  TriangleMesh reconstruction = planeMesh (1.0, 10, 0.25);
  for (auto& v : reconstruction.vertices)
    v += Eigen::Vector3f (0.5f, 0.5f, 0.0f);
  MeshComparisonOptions options;
  options.f_threshold_m = 0.25 + 1e-9;
  const MeshComparison result = compareMeshes (truth, reconstruction, options);
  EXPECT_NEAR (result.accuracy.mean, 0.25, 1e-12);
  EXPECT_NEAR (result.accuracy.median, 0.25, 1e-12);
  EXPECT_NEAR (result.accuracy.max, 0.25, 1e-12);
  EXPECT_EQ (result.precision, 1.0);
  EXPECT_NEAR (result.recall, 0.25, 0.025);
  EXPECT_NEAR (result.f_score, 2.0 * result.recall / (1.0 + result.recall), 1e-12);
  // The farthest points of the truth are its corners.
  EXPECT_NEAR (result.completeness.max, std::sqrt (0.5 * 0.5 * 2.0 + 0.25 * 0.25), 0.02);
  EXPECT_LE (result.completeness.max, std::sqrt (0.5 * 0.5 * 2.0 + 0.25 * 0.25));
  options.f_threshold_m = 0.25 - 1e-9;
  EXPECT_EQ (compareMeshes (truth, reconstruction, options).f_score, 0.0);
}

TEST (MeshComparison, OfSpheresIsTheDifferenceOfRadii)
{
  const MeshComparison result = compareMeshes (sphereMesh (0.1, 64), sphereMesh (0.12, 64));
  const double facets = 0.12 * (1.0 - std::cos (M_PI / 64.0)); // of the polyhedra, inside the spheres
  EXPECT_NEAR (result.accuracy.mean, 0.02, facets);
  EXPECT_NEAR (result.completeness.mean, 0.02, facets);
  EXPECT_LT (result.accuracy.max - result.accuracy.median, 2.0 * facets);
}

TEST (MeshComparison, OfAHalfSphereMissesTheOtherHalf)
{
  constexpr double radius = 0.1;
  const TriangleMesh whole = sphereMesh (radius, 64);
  const MeshComparison result = compareMeshes (whole, upperPart (whole));
  EXPECT_LT (result.accuracy.max, 1e-8);
  // From a point at latitude -a to the rim: 2 r sin (a / 2); the mean over the lower half, by area cos (a) da, is
  // 2 r (2 sqrt (2) - 2) / 3, and the upper half has none.
  const double mean = radius * (2.0 * std::sqrt (2.0) - 2.0) / 3.0;
  EXPECT_NEAR (result.completeness.mean, mean, 0.03 * mean);
  EXPECT_NEAR (result.completeness.max, std::sqrt (2.0) * radius, 0.02 * radius);
  EXPECT_EQ (result.precision, 1.0);
}

TEST (MeshComparison, DoesNotDependOnThreads)
{
  MeshComparisonOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const TriangleMesh truth = torusMesh (0.1, 0.03, 48, 24), sphere = sphereMesh (0.1, 24);
  const MeshComparison a = compareMeshes (truth, sphere, one), b = compareMeshes (truth, sphere, three);
  EXPECT_EQ (a.accuracy.mean, b.accuracy.mean);
  EXPECT_EQ (a.completeness.p95, b.completeness.p95);
  EXPECT_EQ (a.f_score, b.f_score);
}

TEST (MeshComparison, RefusesWhatIsNoSurface)
{
  const TriangleMesh good = planeMesh (1.0, 2);
  EXPECT_NE (messageOf<DegenerateInput> ([&] { compareMeshes (good, TriangleMesh ()); }).find ("reconstruction"),
             std::string::npos);
  EXPECT_NE (messageOf<DegenerateInput> ([&] { compareMeshes (TriangleMesh (), good); }).find ("truth"),
             std::string::npos);
  TriangleMesh flat = good;
  flat.triangles = {{0, 1, 2}, {3, 3, 4}};
  EXPECT_THROW (compareMeshes (good, flat), DegenerateInput);
  TriangleMesh nan = good;
  nan.vertices[4].y () = std::numeric_limits<float>::quiet_NaN ();
  EXPECT_NE (messageOf<InvalidArgument> ([&] { compareMeshes (good, nan); }).find ("vertex 4"), std::string::npos);
  TriangleMesh unused = good;
  unused.vertices.emplace_back (std::numeric_limits<float>::quiet_NaN (), 0.0f, 0.0f);
  EXPECT_LT (compareMeshes (good, unused).accuracy.max, 1e-8); // no triangle has it
  TriangleMesh wrong = good;
  wrong.triangles[0][0] = 99;
  EXPECT_THROW (compareMeshes (wrong, good), InvalidArgument);
  MeshComparisonOptions options;
  options.samples = 0;
  EXPECT_THROW (compareMeshes (good, good, options), InvalidArgument);
}

TEST (MeshComparison, OfAScanIsThatOfItsPoints)
{
  const TriangleMesh plane = planeMesh (1.0, 1);
  TriangleMesh scan; // 5 mm above it, every centimetre
  for (int i = 0; i <= 100; ++i)
    for (int j = 0; j <= 100; ++j)
      scan.vertices.emplace_back (plane.vertices[0] + Eigen::Vector3f (0.01f * i, 0.01f * j, 0.005f));
  MeshComparisonOptions options;
  options.samples = 5000;
  for (const bool is_truth : {true, false})
  {
    const MeshComparison comparison = is_truth ? compareMeshes (scan, plane, options)
                                               : compareMeshes (plane, scan, options);
    const ErrorStatistics& of_points = is_truth ? comparison.completeness : comparison.accuracy;
    const ErrorStatistics& of_mesh = is_truth ? comparison.accuracy : comparison.completeness;
    EXPECT_NEAR (of_points.mean, 0.005, 1e-6); // to the mesh exactly
    EXPECT_NEAR (of_points.max, 0.005, 1e-6);
    EXPECT_GT (of_mesh.mean, 0.005); // to the nearest of points with a spacing
    EXPECT_LE (of_mesh.max, std::sqrt (0.005 * 0.005 * 3.0) + 1e-6);
  }
  const MeshSummary summary = summarizeMesh (scan);
  EXPECT_EQ (summary.vertices, scan.vertices.size ());
  EXPECT_NEAR (*summary.point_spacing_m, 0.01, 1e-5);
  EXPECT_FALSE (summary.volume_m3);
  scan.vertices[3].x () = std::numeric_limits<float>::quiet_NaN ();
  EXPECT_THROW (compareMeshes (plane, scan), InvalidArgument);
}

TEST (MeshSummary, KnowsVolumesOfClosedMeshesOnly)
{
  const TriangleMesh box = boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.2f, 0.3f});
  const MeshSummary closed = summarizeMesh (box);
  ASSERT_TRUE (closed.volume_m3);
  EXPECT_NEAR (*closed.volume_m3, 0.006, 1e-8);
  EXPECT_NEAR (closed.area_m2, 0.22, 1e-7);
  EXPECT_EQ (closed.topology.euler, 2);
  const MeshSummary open = summarizeMesh (upperPart (sphereMesh (0.1, 8)));
  EXPECT_FALSE (open.volume_m3);
  EXPECT_EQ (open.topology.boundary_edges, 16);
}

TEST (ErrorStatistics, AreThoseOfTheDefinition)
{
  const ErrorStatistics s = errorStatistics ({4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ (s.mean, 2.5);
  EXPECT_DOUBLE_EQ (s.median, 2.5);
  EXPECT_DOUBLE_EQ (s.rmse, std::sqrt (30.0 / 4.0));
  EXPECT_DOUBLE_EQ (s.p95, 3.85);
  EXPECT_DOUBLE_EQ (s.max, 4.0);
  EXPECT_EQ (errorStatistics ({}).max, 0.0);
}

TEST (FrameWarnings, NameUnitsAndFrames)
{
  const auto of = [] (const TriangleMesh& mesh) { return summarizeMesh (mesh); };
  const TriangleMesh box = boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.1f});
  EXPECT_TRUE (frameWarnings (of (box), of (box)).empty ());
  const auto millimetres = frameWarnings (of (box), of (boxMesh ({0.0f, 0.0f, 0.0f}, {100.0f, 100.0f, 100.0f})));
  ASSERT_EQ (millimetres.size (), 1u);
  EXPECT_NE (millimetres[0].find ("1e+03 times as large"), std::string::npos) << millimetres[0];
  const auto centimetres = frameWarnings (of (box), of (boxMesh ({0.0f, 0.0f, 0.0f}, {10.0f, 10.0f, 10.0f})));
  ASSERT_EQ (centimetres.size (), 1u);
  EXPECT_NE (centimetres[0].find ("100 times as large as the truth: in another unit"), std::string::npos);
  const auto away = frameWarnings (of (box), of (boxMesh ({5.0f, 0.0f, 0.0f}, {5.1f, 0.1f, 0.1f})));
  ASSERT_EQ (away.size (), 1u);
  EXPECT_NE (away[0].find ("do not overlap"), std::string::npos);
}
