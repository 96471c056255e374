// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/mesh/even_samples.h"

#include "common/not_a_number.h"
#include "common/small_meshes.h"
#include "pcl_cosection/mesh/area_samples.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

struct SampledShape
{
  const char* name;
  TriangleMesh mesh;
  std::size_t count;
};

std::ostream&
operator<< (std::ostream& out, const SampledShape& shape)
{
  return out << shape.name << " with " << shape.count << " points";
}

/** \brief The least distance of two of some points; of those with normals that agree, if asked for. */
double
leastDistance (const TriangleMesh& points, bool of_one_side = false)
{
  double least = std::numeric_limits<double>::infinity ();
  for (std::size_t a = 0; a < points.vertices.size (); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!of_one_side || points.normals[a].dot (points.normals[b]) > 0.0f)
        least = std::min (least, static_cast<double> ((points.vertices[a] - points.vertices[b]).norm ()));
  return least;
}

/** \brief The largest distance of a place on a mesh to the nearest point. */
double
largestGap (const TriangleMesh& mesh, const TriangleMesh& points)
{
  double largest = 0.0;
  for (const Eigen::Vector3d& place : sampleSurface (mesh, 2000, 5))
  {
    double nearest = std::numeric_limits<double>::infinity ();
    for (const Eigen::Vector3f& point : points.vertices)
      nearest = std::min (nearest, (point.cast<double> () - place).norm ());
    largest = std::max (largest, nearest);
  }
  return largest;
}

std::vector<Eigen::Vector3d>
positionsOf (const TriangleMesh& points)
{
  std::vector<Eigen::Vector3d> positions;
  for (const Eigen::Vector3f& point : points.vertices)
    positions.push_back (point.cast<double> ());
  return positions;
}

double
farthestFromSurface (const TriangleMesh& mesh, const TriangleMesh& points)
{
  const std::vector<double> distances = SurfaceDistance (mesh).of (positionsOf (points));
  return *std::max_element (distances.begin (), distances.end ());
}

/** \brief One triangle, as long and as wide as given. */
TriangleMesh
triangleMesh (float length, float width)
{
  TriangleMesh mesh;
  mesh.vertices = {{0.0f, 0.0f, 0.0f}, {length, 0.0f, 0.0f}, {0.0f, width, 0.0f}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TriangleMesh
unevenSphere ()
{
  return test::sphereMesh (0.1, 60); // whose triangles at the poles are a thirtieth of the others
}

} // namespace

class EvenSamplesOfShape : public testing::TestWithParam<SampledShape>
{};

INSTANTIATE_TEST_SUITE_P (
    Shapes, EvenSamplesOfShape,
    testing::Values (SampledShape{"sphere", unevenSphere (), 10}, SampledShape{"sphere", unevenSphere (), 100},
                     SampledShape{"sphere", unevenSphere (), 3000},
                     SampledShape{"box", test::boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.06f, 0.2f}), 2000},
                     SampledShape{"torus", test::torusMesh (0.1, 0.03, 60, 30), 2000},
                     SampledShape{"sheet", test::sheetMesh (20, [] (double x, double) { return x < 0.7; }), 1000},
                     SampledShape{"thousand kilometres", triangleMesh (1e6f, 1e6f), 500},
                     SampledShape{"nanometres", triangleMesh (1e-9f, 1e-9f), 500}));

TEST_P (EvenSamplesOfShape, AreApartAndCoverIt)
{
  const auto& [name, mesh, count] = GetParam ();
  const TriangleMesh points = sampleEvenly (mesh, count);
  EXPECT_TRUE (points.triangles.empty ());
  ASSERT_EQ (points.vertices.size (), count);
  ASSERT_EQ (points.normals.size (), count);
  const double spacing = hexagonalSpacing (surfaceArea (mesh), count);
  EXPECT_GT (leastDistance (points), 0.6 * spacing);
  const double size = vertexBox (mesh).sizes ().maxCoeff ();
  EXPECT_LT (largestGap (mesh, points), 1.2 * spacing);
  EXPECT_LT (farthestFromSurface (mesh, points), 1e-6 * size);
}

TEST (EvenSamples, AreFarMoreEvenThanRandomPoints)
{
  const TriangleMesh mesh = unevenSphere ();
  TriangleMesh random;
  for (const Eigen::Vector3d& point : sampleSurface (mesh, 1000))
    random.vertices.push_back (point.cast<float> ());
  EXPECT_GT (leastDistance (sampleEvenly (mesh, 1000)), 10.0 * leastDistance (random));
}

TEST (EvenSamples, CoverEachSideOfAThinWallByItself)
{
  const TriangleMesh wall = test::boxMesh ({0.0f, 0.0f, 0.0f}, {0.1f, 0.1f, 0.0005f});
  const TriangleMesh points = sampleEvenly (wall, 400); // 8 mm apart
  EXPECT_GT (leastDistance (points, true), 0.6 * hexagonalSpacing (surfaceArea (wall), 400));
  const auto upper = std::count_if (points.normals.begin (), points.normals.end (),
                                    [] (const Eigen::Vector3f& normal) { return normal.z () > 0.5f; });
  EXPECT_NEAR (static_cast<double> (upper), 200.0, 10.0);
}

TEST (EvenSamples, FollowTheAreaOfANeedle)
{
  const TriangleMesh needle = triangleMesh (1.0f, 1e-6f);
  const TriangleMesh points = sampleEvenly (needle, 1000);
  ASSERT_EQ (points.vertices.size (), 1000u);
  EXPECT_GT (leastDistance (points), 0.6 * hexagonalSpacing (surfaceArea (needle), 1000));
  const auto in_thicker_half = std::count_if (points.vertices.begin (), points.vertices.end (),
                                              [] (const Eigen::Vector3f& p) { return p.x () < 0.5f; });
  EXPECT_NEAR (static_cast<double> (in_thicker_half), 750.0, 50.0);
}

TEST (EvenSamples, AreTheSameForAnyNumberOfThreads)
{
  const TriangleMesh mesh = test::torusMesh (0.1, 0.03, 60, 30);
  const TriangleMesh points = sampleEvenly (mesh, 5000, 1);
  for (const int threads : {2, 3, 0})
  {
    const TriangleMesh again = sampleEvenly (mesh, 5000, threads);
    EXPECT_EQ (again.vertices, points.vertices);
    EXPECT_EQ (again.normals, points.normals);
  }
}

TEST (EvenSamples, TakeWhatTheVerticesHave)
{
  TriangleMesh mesh = test::boxMesh ({0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f});
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    const Eigen::Vector3f& p = mesh.vertices[v];
    mesh.colours.push_back ({static_cast<std::uint8_t> (200.0f * p.x ()), static_cast<std::uint8_t> (100.0f * p.y ()),
                             static_cast<std::uint8_t> (50.0f * p.z ())});
    mesh.intensity.push_back (5.0f + p.x ());
    mesh.confidence.push_back (0.5f * p.y ());
    mesh.sigma_m.push_back (0.01f * p.z () + 0.01f);
    mesh.provenance.push_back (static_cast<std::uint8_t> (v % 4));
  }
  const TriangleMesh points = sampleEvenly (mesh, 500);
  ASSERT_EQ (points.colours.size (), 500u);
  ASSERT_EQ (points.provenance.size (), 500u);
  for (std::size_t n = 0; n < 500; ++n)
  {
    const Eigen::Vector3f& p = points.vertices[n];
    EXPECT_NEAR (points.colours[n][0], 200.0f * p.x (), 0.51f);
    EXPECT_NEAR (points.colours[n][1], 100.0f * p.y (), 0.51f);
    EXPECT_NEAR (points.colours[n][2], 50.0f * p.z (), 0.51f);
    EXPECT_NEAR (points.intensity[n], 5.0f + p.x (), 1e-5f);
    EXPECT_NEAR (points.confidence[n], 0.5f * p.y (), 1e-5f);
    EXPECT_NEAR (points.sigma_m[n], 0.01f * p.z () + 0.01f, 1e-7f);
    const auto nearest = std::min_element (
        mesh.vertices.begin (), mesh.vertices.end (),
        [&] (const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return (a - p).norm () < (b - p).norm (); });
    EXPECT_EQ (points.provenance[n], (nearest - mesh.vertices.begin ()) % 4);
  }
}

TEST (EvenSamples, HaveOnlyWhatTheVerticesHave)
{
  const TriangleMesh points = sampleEvenly (test::boxMesh ({0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}), 50);
  EXPECT_TRUE (points.colours.empty ());
  EXPECT_TRUE (points.intensity.empty ());
  EXPECT_TRUE (points.confidence.empty ());
  EXPECT_TRUE (points.sigma_m.empty ());
  EXPECT_TRUE (points.provenance.empty ());
}

TEST (EvenSamples, HaveSmoothNormalsOfVertices)
{
  const TriangleMesh points = sampleEvenly (test::sphereMesh (0.1, 12), 300);
  for (std::size_t n = 0; n < 300; ++n)
  {
    EXPECT_NEAR (points.normals[n].norm (), 1.0f, 1e-5f);
    EXPECT_GT (points.normals[n].dot (points.vertices[n].normalized ()), 0.9999f);
  }
}

TEST (EvenSamples, HaveNormalsOfTrianglesWhereVerticesHaveNone)
{
  TriangleMesh mesh = test::boxMesh ({-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f});
  for (const Eigen::Vector3f& bad :
       {Eigen::Vector3f (0.0f, 0.0f, 0.0f), Eigen::Vector3f (0.0f, test::not_a_number, 0.0f)})
  {
    const TriangleMesh points = sampleEvenly (mesh, 300);
    for (std::size_t n = 0; n < 300; ++n)
      EXPECT_NEAR (points.normals[n].dot (points.vertices[n]), 1.0f, 1e-5f);
    mesh.normals.assign (mesh.vertices.size (), bad);
  }
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    mesh.normals[v] = -mesh.vertices[v].normalized ();
  const TriangleMesh points = sampleEvenly (mesh, 300);
  for (std::size_t n = 0; n < 300; ++n)
    EXPECT_NEAR (points.normals[n].dot (points.vertices[n]), 1.0f, 1e-5f);
}

TEST (EvenSamples, AvoidTrianglesWithoutArea)
{
  TriangleMesh mesh = triangleMesh (1.0f, 1.0f);
  mesh.vertices.insert (mesh.vertices.end (), {{5.0f, 0.0f, 0.0f}, {6.0f, 0.0f, 0.0f}, {7.0f, 0.0f, 0.0f}});
  mesh.triangles = {{3, 4, 5}, {0, 1, 2}, {3, 3, 3}, {0, 0, 5}};
  mesh.vertices.emplace_back (std::numeric_limits<float>::infinity (), 0.0f, 0.0f); // of no triangle
  const TriangleMesh points = sampleEvenly (mesh, 200);
  ASSERT_EQ (points.vertices.size (), 200u);
  for (const Eigen::Vector3f& p : points.vertices)
    EXPECT_LE (p.x () + p.y (), 1.00001f);
}

TEST (EvenSamples, AreAsManyAsWantedWhereOnlyAFewPlacesDiffer)
{
  TriangleMesh mesh = triangleMesh (1.0f, 1.0f);
  for (Eigen::Vector3f& v : mesh.vertices)
    v = v * 2e-6f + Eigen::Vector3f (8.0f, 8.0f, 8.0f); // some four numbers along each side
  for (const std::size_t count : {1u, 3u, 5000u})
    EXPECT_EQ (sampleEvenly (mesh, count).vertices.size (), count);
}

TEST (EvenSamples, RefuseWhatHasNoSurface)
{
  const TriangleMesh mesh = triangleMesh (1.0f, 1.0f);
  EXPECT_THROW (sampleEvenly (TriangleMesh (), 10), DegenerateInput);
  EXPECT_THROW (sampleEvenly (triangleMesh (1.0f, 0.0f), 10), DegenerateInput);
  EXPECT_THROW (sampleEvenly (mesh, 0), InvalidArgument);
  EXPECT_THROW (sampleEvenly (mesh, most_even_samples + 1), InvalidArgument);
  TriangleMesh broken = mesh;
  broken.triangles.push_back ({0, 1, 3});
  EXPECT_THROW (sampleEvenly (broken, 10), InvalidArgument);
  broken = mesh;
  broken.confidence = {1.0f};
  EXPECT_THROW (sampleEvenly (broken, 10), InvalidArgument);
  broken = mesh;
  broken.vertices[1].x () = test::not_a_number;
  EXPECT_THROW (sampleEvenly (broken, 10), InvalidArgument);
}
