// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "analytic_fields.h"

#include "common/mesh_shape.h"

#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace pcl::cosection;

namespace {

/** \brief Handles everywhere: a gyroid, cut by the box of the volume. */
SignedDistanceField
gyroidField (double waves_per_m)
{
  const double w = 2.0 * M_PI * waves_per_m;
  return test::sampleField (
      [w] (const Eigen::Vector3d& p) {
        return (std::sin (w * p.x ()) * std::cos (w * p.y ()) + std::sin (w * p.y ()) * std::cos (w * p.z ()) +
                std::sin (w * p.z ()) * std::cos (w * p.x ())) /
               w;
      },
      0.13, 0.0083);
}

/** \brief A few random waves: blobs, caves and handles of all sizes. */
SignedDistanceField
randomField (unsigned seed)
{
  std::mt19937 random (seed);
  std::uniform_real_distribution<double> uniform (-1.0, 1.0);
  std::vector<Eigen::Vector4d> waves; // wave vector, phase
  for (int n = 0; n < 12; ++n)
    waves.emplace_back (60.0 * uniform (random), 60.0 * uniform (random), 60.0 * uniform (random),
                        M_PI * uniform (random));
  return test::sampleField (
      [waves] (const Eigen::Vector3d& p) {
        double sum = 0.3;
        for (const auto& wave : waves)
          sum += std::sin (wave.head<3> ().dot (p) + wave.w ());
        return 0.02 * sum;
      },
      0.13, 0.0102);
}

void
expectGoodAtAllTargets (const TriangleMesh& mesh)
{
  ASSERT_TRUE (computeTopology (mesh).closed_manifold);
  const double volume = computeMassProperties (mesh).volume_m3;
  for (const std::size_t divisor : {2, 5, 20, 100})
  {
    SCOPED_TRACE ("by " + std::to_string (divisor));
    const std::size_t target = mesh.triangles.size () / divisor;
    const TriangleMesh result = decimate (mesh, target);
    test::expectSameTopology (result, mesh);
    EXPECT_EQ (result.normals.size (), result.vertices.size ());
    EXPECT_GT (computeMassProperties (result).volume_m3, 0.0);
    if (divisor > 5)
      continue;
    EXPECT_LE (result.triangles.size (), target);
    EXPECT_NEAR (computeMassProperties (result).volume_m3 / volume, 1.0, 0.01);
  }
}

} // namespace

TEST (DecimatedIsoSurface, OfAGyroidKeepsAllHandles)
{
  const TriangleMesh mesh = extractIsoSurface (gyroidField (10.0));
  ASSERT_LT (computeTopology (mesh).euler, -100);
  expectGoodAtAllTargets (mesh);
}

TEST (DecimatedIsoSurface, OfRandomWavesKeepsItsTopology)
{
  for (unsigned seed = 0; seed < 2; ++seed)
    expectGoodAtAllTargets (extractIsoSurface (randomField (seed)));
}

TEST (DecimatedIsoSurface, OfNoiseKeepsItsTopology)
{
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    std::mt19937 random (seed);
    std::uniform_real_distribution<float> uniform (-0.5f, 0.5f);
    SignedDistanceField field;
    field.grid.dims = {9, 8, 10};
    field.grid.voxel_size_m = 0.01;
    field.values.resize (field.grid.size ());
    for (auto& value : field.values)
      value = uniform (random);
    for (const bool closed : {true, false})
    {
      const TriangleMesh mesh = extractIsoSurface (field, {closed, 1});
      for (const std::size_t target : {mesh.triangles.size () / 2, std::size_t{1}})
        test::expectSameTopology (decimate (mesh, target), mesh);
    }
  }
}

TEST (DecimatedIsoSurface, OfABoxIsABoxAgain)
{
  const double h = 0.005;
  const auto distance = test::box ({0.1, 0.06, 0.03});
  const TriangleMesh result = decimate (extractIsoSurface (test::sampleField (distance, 0.13, h)), 12);
  ASSERT_EQ (result.triangles.size (), 12u);
  EXPECT_TRUE (computeTopology (result).closed_manifold);
  for (const auto& triangle : result.triangles)
  {
    const Eigen::Matrix3d corners = test::cornersOf (result, triangle);
    EXPECT_NEAR (distance (corners.rowwise ().mean ()), 0.0, 0.2 * h);
    for (int n = 0; n < 3; ++n)
      EXPECT_NEAR (distance (corners.col (n)), 0.0, 0.5 * h);
  }
}

TEST (DecimatedIsoSurface, AvoidsThinTrianglesWhereThatCostsNothing)
{
  const auto distance = test::box ({0.1, 0.06, 0.03});
  const TriangleMesh mesh = extractIsoSurface (test::sampleField (distance, 0.13, 0.0037));
  const auto thin = [&] (double min_quality) {
    DecimationOptions options;
    options.max_triangles = 1000;
    options.min_quality = min_quality;
    const TriangleMesh result = decimate (mesh, options);
    EXPECT_NEAR (computeMassProperties (result).volume_m3 / computeMassProperties (mesh).volume_m3, 1.0, 1e-4);
    return std::count_if (result.triangles.begin (), result.triangles.end (), [&] (const TriangleMesh::Triangle& t) {
      return test::qualityOf (result, t) < DecimationOptions ().min_quality;
    });
  };
  EXPECT_LT (3 * thin (DecimationOptions ().min_quality), thin (0.0));
}
