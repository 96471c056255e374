// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "analytic_fields.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cstring>
#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

struct Shape
{
  const char* name;
  test::Distance distance;
  int euler;
  bool smooth;
};

std::vector<Shape>
shapes ()
{
  return {{"sphere", test::sphere (0.1), 2, true},
          {"torus", test::torus (0.08, 0.03), 0, true},
          {"box", test::box ({0.1, 0.06, 0.03}), 2, false}};
}

template <typename T>
void
expectSameBytes (const std::vector<T>& a, const std::vector<T>& b)
{
  ASSERT_EQ (a.size (), b.size ());
  EXPECT_EQ (std::memcmp (a.data (), b.data (), a.size () * sizeof (T)), 0);
}

Eigen::Vector3d
faceNormal (const TriangleMesh& mesh, const TriangleMesh::Triangle& t)
{
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double> ();
  return (mesh.vertices[t[1]].cast<double> () - a).cross (mesh.vertices[t[2]].cast<double> () - a);
}

/** \brief A field of uniform noise with exact zeros and NaN values. */
SignedDistanceField
noiseField (const Eigen::Vector3i& dims, unsigned seed, double share_inside)
{
  std::mt19937 random (seed);
  std::uniform_real_distribution<float> uniform (static_cast<float> (-share_inside),
                                                 static_cast<float> (1.0 - share_inside));
  std::uniform_int_distribution<int> special (0, 29);
  SignedDistanceField field;
  field.grid.dims = dims;
  field.grid.voxel_size_m = 0.01;
  field.grid.origin_m = Eigen::Vector3d (-0.3, 0.2, 1.0);
  field.values.resize (field.grid.size ());
  for (auto& value : field.values)
    switch (special (random))
    {
    case 0:
      value = 0.0f;
      break;
    case 1:
      value = -0.0f;
      break;
    case 2:
      value = std::numeric_limits<float>::quiet_NaN ();
      break;
    case 3:
      value = std::numeric_limits<float>::infinity ();
      break;
    case 4:
      value = -std::numeric_limits<float>::infinity ();
      break;
    case 5:
      value = -std::numeric_limits<float>::denorm_min ();
      break;
    case 6:
      value = std::numeric_limits<float>::lowest ();
      break;
    case 7:
      value = std::numeric_limits<float>::max ();
      break;
    default:
      value = uniform (random);
    }
  return field;
}

void
expectStrictlyInside (const TriangleMesh& mesh, const VoxelGrid& grid)
{
  for (const auto& v : mesh.vertices)
  {
    const Eigen::Vector3d p = grid.toVoxel (v.cast<double> ());
    EXPECT_GT (p.minCoeff (), 0.0);
    EXPECT_LT ((p - grid.dims.cast<double> ()).maxCoeff (), -1.0);
  }
}

} // namespace

class IsoSurfaceOfShapes : public ::testing::TestWithParam<double>
{};

TEST_P (IsoSurfaceOfShapes, IsClosedAndAccurate)
{
  const double h = GetParam ();
  for (const Shape& shape : shapes ())
  {
    SCOPED_TRACE (shape.name);
    const auto field = test::sampleField (shape.distance, 0.13, h);
    const auto mesh = extractIsoSurface (field);
    const auto topology = computeTopology (mesh);
    EXPECT_TRUE (topology.closed_manifold);
    EXPECT_EQ (topology.euler, shape.euler);
    EXPECT_EQ (topology.components, 1);
    EXPECT_GT (computeMassProperties (mesh).volume_m3, 0.0);
    expectStrictlyInside (mesh, field.grid);

    // Linear interpolation of a field of curvature 1/r errs by h^2 / (8 r); edges of the box by less than a voxel.
    const double tolerance = (shape.smooth ? h * h / (8 * 0.03) + 2e-3 * h : 0.6 * h);
    ASSERT_EQ (mesh.normals.size (), mesh.vertices.size ());
    for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    {
      EXPECT_NEAR (shape.distance (mesh.vertices[v].cast<double> ()), 0.0, tolerance);
      EXPECT_NEAR (mesh.normals[v].norm (), 1.0, 1e-5);
    }
    for (const auto& t : mesh.triangles)
    {
      const Eigen::Vector3d n = faceNormal (mesh, t);
      ASSERT_GT (n.norm (), 0.0);
      if (shape.smooth)
      {
        const Eigen::Vector3d smooth = (mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]).cast<double> ();
        EXPECT_GT (n.dot (smooth), 0.0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P (VoxelSizes, IsoSurfaceOfShapes, ::testing::Values (0.0101, 0.005, 0.0037));

TEST (IsoSurface, NormalsOfASpherePointOutward)
{
  const double h = 0.005;
  const auto mesh = extractIsoSurface (test::sampleField (test::sphere (0.1), 0.13, h));
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    EXPECT_GT (mesh.normals[v].dot (mesh.vertices[v].normalized ()), 0.999f);
}

TEST (IsoSurface, OfNoiseIsAlwaysAClosedManifold)
{
  const std::vector<Eigen::Vector3i> sizes = {{3, 3, 3}, {3, 7, 5}, {11, 4, 9}, {17, 13, 15}};
  for (const auto& dims : sizes)
    for (unsigned seed = 0; seed < 60; ++seed)
    {
      const auto field = noiseField (dims, seed, 0.2 + 0.15 * (seed % 5));
      const auto mesh = extractIsoSurface (field);
      if (mesh.empty ())
        continue;
      const auto topology = computeTopology (mesh);
      ASSERT_TRUE (topology.closed_manifold) << dims.transpose () << ", seed " << seed;
      ASSERT_EQ (mesh.normals.size (), mesh.vertices.size ());
      expectStrictlyInside (mesh, field.grid);
      for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
      {
        ASSERT_TRUE (mesh.vertices[v].allFinite ());
        ASSERT_NEAR (mesh.normals[v].norm (), 1.0f, 1e-4f);
      }
    }
}

TEST (IsoSurface, OfTwoNeighbouringCellsIsAClosedManifoldInEveryCase)
{
  for (unsigned inside = 0; inside < (1u << 12); ++inside)
  {
    SignedDistanceField field;
    field.grid.dims = {5, 4, 4};
    field.grid.voxel_size_m = 1.0;
    field.values.assign (field.grid.size (), 1.0f);
    for (int bit = 0; bit < 12; ++bit)
      if ((inside >> bit) & 1u)
        field.values[field.grid.index (1 + bit % 3, 1 + bit / 3 % 2, 1 + bit / 6)] = -1.0f;
    const auto mesh = extractIsoSurface (field);
    if (inside == 0)
      EXPECT_TRUE (mesh.empty ());
    else
      ASSERT_TRUE (computeTopology (mesh).closed_manifold) << inside;
  }
}

TEST (IsoSurface, DoesNotDependOnTheNumberOfThreads)
{
  const auto field = noiseField ({23, 19, 21}, 5, 0.4);
  for (const bool closed : {true, false})
  {
    const auto one = extractIsoSurface (field, {closed, 1});
    for (const int threads : {2, 5})
    {
      const auto many = extractIsoSurface (field, {closed, threads});
      expectSameBytes (one.vertices, many.vertices);
      expectSameBytes (one.normals, many.normals);
      expectSameBytes (one.triangles, many.triangles);
    }
  }
}

TEST (IsoSurface, ClosesInsideTheVolumeOnlyOnRequest)
{
  const auto field = test::sampleField ([] (const Eigen::Vector3d& p) { return p.z (); }, 0.05, 0.01);
  const auto open = extractIsoSurface (field, {false, 1});
  const auto topology = computeTopology (open);
  EXPECT_FALSE (topology.closed_manifold);
  EXPECT_EQ (topology.boundary_edges, 4 * (field.grid.dims.x () - 1));
  EXPECT_EQ (topology.non_manifold_edges, 0);
  EXPECT_EQ (topology.non_manifold_vertices, 0);
  for (std::size_t v = 0; v < open.vertices.size (); ++v)
  {
    EXPECT_NEAR (open.vertices[v].z (), 0.0f, 2e-5f);
    EXPECT_NEAR (open.normals[v].z (), 1.0f, 1e-6f);
  }

  const auto closed = extractIsoSurface (field);
  EXPECT_TRUE (computeTopology (closed).closed_manifold);
  EXPECT_EQ (computeTopology (closed).euler, 2);
  expectStrictlyInside (closed, field.grid);
}

TEST (IsoSurface, OfFieldsWithoutASignChangeIsEmpty)
{
  for (const float value :
       {1.0f, 0.0f, std::numeric_limits<float>::quiet_NaN (), -std::numeric_limits<float>::infinity ()})
  {
    SignedDistanceField field;
    field.grid.dims = {4, 5, 6};
    field.grid.voxel_size_m = 0.1;
    field.values.assign (field.grid.size (), value);
    EXPECT_TRUE (extractIsoSurface (field).empty ());
    EXPECT_TRUE (extractIsoSurface (field, {false, 0}).empty ());
  }
}

TEST (IsoSurface, OfFlatGrids)
{
  SignedDistanceField field;
  field.grid.dims = {5, 5, 1};
  field.grid.voxel_size_m = 0.1;
  field.values.assign (field.grid.size (), 1.0f);
  field.values[12] = -1.0f;
  EXPECT_TRUE (extractIsoSurface (field).empty ());
  EXPECT_TRUE (extractIsoSurface (field, {false, 0}).triangles.empty ());
}

TEST (IsoSurface, RefusesFieldsThatDoNotFitTheirGrid)
{
  SignedDistanceField field;
  EXPECT_THROW (extractIsoSurface (field), InvalidArgument);
  field.grid.dims = {4, 4, 4};
  field.values.assign (64, 1.0f);
  EXPECT_THROW (extractIsoSurface (field), InvalidArgument);
  field.grid.voxel_size_m = 0.1;
  EXPECT_NO_THROW (extractIsoSurface (field));
  field.values.pop_back ();
  EXPECT_THROW (extractIsoSurface (field), InvalidArgument);
}
