// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/energy/expected_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

constexpr double noise_m = 0.002, voxel_m = 0.004, size_m = 0.2;

ErrorSources
at (double distance_m, bool has_target)
{
  return {noise_m, voxel_m, distance_m, size_m, has_target};
}

/** \brief A body of voxels of 1 cm with a point in its middle. */
BodyEnergy
smallBody ()
{
  BodyEnergy energy;
  energy.grid.dims = {21, 21, 21};
  energy.grid.voxel_size_m = 0.01;
  return energy;
}

const std::vector<OrientedPoint> middle = {{Eigen::Vector3f::Constant (0.1f), Eigen::Vector3f::UnitZ (), 1.0f, {}}};

TriangleMesh
meshOf (std::vector<Eigen::Vector3f> vertices)
{
  TriangleMesh mesh;
  mesh.vertices = std::move (vertices);
  return mesh;
}

} // namespace

TEST (ExpectedError, IsThatOfTheSensorAtItsPoints)
{
  const double sigma_m = expectedError (at (0.0, false));
  EXPECT_GE (sigma_m, noise_m);
  EXPECT_LE (sigma_m, noise_m + 0.5 * voxel_m);
  EXPECT_DOUBLE_EQ (sigma_m, expectedError (at (0.0, true)));
}

TEST (ExpectedError, GrowsWithTheDistanceUpToAShareOfTheSize)
{
  for (const bool has_target : {false, true})
  {
    double last_m = 0.0;
    for (double distance_m = 0.0; distance_m < 2.0 * size_m; distance_m += 0.001)
    {
      const double sigma_m = expectedError (at (distance_m, has_target));
      EXPECT_GE (sigma_m, last_m);
      // The truth goes through the points: two sigma need not exceed the distance by more than the noise.
      EXPECT_LE (2.0 * sigma_m, std::hypot (2.0 * noise_m, voxel_m, distance_m) + 1e-12);
      last_m = sigma_m;
    }
    EXPECT_LE (last_m, 0.1 * size_m);
    EXPECT_DOUBLE_EQ (last_m, expectedError (at (std::numeric_limits<double>::infinity (), has_target)));
  }
}

TEST (ExpectedError, IsSmallerWhereAPriorHasEvidence)
{
  EXPECT_LT (expectedError (at (0.5 * size_m, true)), expectedError (at (0.5 * size_m, false)));
}

TEST (ExpectedError, ScalesWithTheScene)
{
  const ErrorSources twice = {2.0 * noise_m, 2.0 * voxel_m, 0.1, 2.0 * size_m, false};
  EXPECT_NEAR (expectedError (twice), 2.0 * expectedError (at (0.05, false)), 1e-12);
}

TEST (ErrorSources, HaveTheDistanceToTheNearestPoint)
{
  const TriangleMesh mesh = meshOf ({{0.1f, 0.1f, 0.1f}, {0.1f, 0.1f, 0.15f}, {0.04f, 0.1f, 0.18f}});
  const std::vector<ErrorSources> sources = errorSources (smallBody (), middle, {}, size_m, mesh);
  ASSERT_EQ (sources.size (), 3u);
  EXPECT_NEAR (sources[0].data_distance_m, 0.0, 1e-6);
  EXPECT_NEAR (sources[1].data_distance_m, 0.05, 1e-6);
  EXPECT_NEAR (sources[2].data_distance_m, 0.1, 1e-6);
  for (const ErrorSources& source : sources)
  {
    EXPECT_EQ (source.noise_m, 0.0); // there is no view
    EXPECT_EQ (source.voxel_size_m, 0.01);
    EXPECT_FALSE (source.has_target);
  }
}

TEST (ErrorSources, AreFiniteWithoutPoints)
{
  const TriangleMesh mesh = meshOf ({{0.1f, 0.1f, 0.1f}, {0.103f, 0.107f, 0.101f}});
  for (const ErrorSources& source : errorSources (smallBody (), {}, {}, size_m, mesh))
    EXPECT_LE (expectedError (source), size_m);
}

TEST (ErrorSources, HaveTheNoiseOfTheNearestViewThatShowsThePlace)
{
  DepthView view;
  view.camera = {640, 480, 570.0, 570.0, 319.5, 239.5};
  const auto from = [] (double z) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
    T.translation () = Eigen::Vector3d (0.1, 0.1, -z);
    return T;
  };
  Eigen::Isometry3d turned_away = from (0.2);
  turned_away.linear () = Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitX ()).toRotationMatrix ();
  const TriangleMesh mesh = meshOf ({{0.1f, 0.1f, 0.1f}});
  const SensorViews views = {{&view, from (1.9)}, {&view, from (0.9)}, {&view, turned_away}};
  EXPECT_NEAR (errorSources (smallBody (), middle, views, size_m, mesh)[0].noise_m, depthNoiseSigma (1.0), 1e-9);
}

TEST (ErrorSources, KnowWhereAPriorHasATarget)
{
  BodyEnergy energy = smallBody ();
  energy.expects_distance.assign (energy.grid.size (), 0);
  energy.expects_distance[energy.grid.index (10, 10, 15)] = 1;
  const TriangleMesh mesh = meshOf ({{0.1f, 0.1f, 0.145f}, {0.1f, 0.1f, 0.125f}});
  const std::vector<ErrorSources> sources = errorSources (energy, middle, {}, size_m, mesh);
  EXPECT_TRUE (sources[0].has_target);
  EXPECT_FALSE (sources[1].has_target);
}
