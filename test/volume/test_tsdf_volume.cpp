// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "tsdf_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN ();
constexpr float infinity_f = std::numeric_limits<float>::infinity ();

template <typename T>
bool
sameBytes (const std::vector<T>& a, const std::vector<T>& b)
{
  return a.size () == b.size () && std::memcmp (a.data (), b.data (), a.size () * sizeof (T)) == 0;
}

bool
sameState (const TsdfVolume& a, const TsdfVolume& b)
{
  return sameBytes (a.field ().values, b.field ().values) && sameBytes (a.weights (), b.weights ());
}

std::size_t
seenVoxels (const TsdfVolume& volume)
{
  std::size_t seen = 0;
  for (const float w : volume.weights ())
    seen += (w > 0.0f);
  return seen;
}

/** \brief Compare with the definition, applied to every voxel in double precision. */
void
expectDefinition (const TsdfVolume& volume, const Image<float>& depth, const PinholeCamera& camera,
                  const Eigen::Isometry3d& T_grid_sensor)
{
  const VoxelGrid& grid = volume.grid ();
  const double truncation = volume.truncation ();
  int checked = 0;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3d p = T_grid_sensor.inverse () * grid.center (i, j, k);
        const std::size_t index = grid.index (i, j, k);
        double expected = std::numeric_limits<double>::quiet_NaN ();
        if (p.z () > 0.0)
        {
          const Eigen::Vector2d pixel = camera.project (p).array () + 0.5;
          if ((pixel - pixel.array ().round ().matrix ()).cwiseAbs ().minCoeff () < 1e-3)
            continue; // between two pixels
          const Eigen::Array2d whole = pixel.array ().floor ();
          if ((whole >= 0.0).all () && whole.x () < camera.width && whole.y () < camera.height)
          {
            const double reading = depth.at (static_cast<int> (whole.x ()), static_cast<int> (whole.y ()));
            const double d = (reading - p.z ()) * p.norm () / p.z ();
            if (std::abs (d + truncation) < 1e-6)
              continue;
            if (std::isfinite (reading) && reading > 0.0 && d >= -truncation)
              expected = std::min (d, truncation);
          }
        }
        ++checked;
        if (std::isnan (expected))
        {
          ASSERT_EQ (volume.weights ()[index], 0.0f) << i << " " << j << " " << k;
          ASSERT_TRUE (std::isnan (volume.field ().values[index]));
        }
        else
        {
          ASSERT_EQ (volume.weights ()[index], 1.0f) << i << " " << j << " " << k;
          ASSERT_NEAR (volume.field ().values[index], expected, 2e-6);
        }
      }
  EXPECT_GT (checked, 0.9 * static_cast<double> (grid.size ()));
}

} // namespace

class TsdfFromPose : public ::testing::TestWithParam<Eigen::Vector3d>
{};

TEST_P (TsdfFromPose, IsTheDefinition)
{
  const PinholeCamera camera = test::smallCamera ();
  const Eigen::Isometry3d pose = test::lookAtOrigin (GetParam ());
  const auto scene = test::nearerRay (test::sphereRay (0.05), test::planeRay ({0.1, 0.2, 1.0}, 0.1));
  const Image<float> depth = test::renderDepth (scene, camera, pose);
  VoxelGrid grid = test::cubeGrid (40, 0.01);
  grid.dims = {40, 33, 47};
  TsdfVolume volume (grid);
  volume.integrate (depth, camera, pose);
  EXPECT_GT (seenVoxels (volume), 0u);
  expectDefinition (volume, depth, camera, pose);
}

// From outside, from beside, and with voxels around and behind the sensor.
INSTANTIATE_TEST_SUITE_P (Poses, TsdfFromPose,
                          ::testing::Values (Eigen::Vector3d (0.0, 0.0, -0.5), Eigen::Vector3d (0.3, -0.4, -0.2),
                                             Eigen::Vector3d (0.1, 0.05, -0.12), Eigen::Vector3d (-0.02, 0.0, 0.07),
                                             Eigen::Vector3d (0.0, 0.195, 0.0)));

TEST (TsdfVolume, SensorOnAVoxelCentre)
{
  const VoxelGrid grid = test::cubeGrid (31, 0.01);
  TsdfVolume volume (grid);
  volume.integrate (test::wallDepth (0.08f), test::smallCamera (), Eigen::Isometry3d::Identity ());
  EXPECT_EQ (volume.weight (Eigen::Vector3d::Zero ()), 0.0f);
  EXPECT_EQ (volume.weight ({0.0, 0.0, -0.05}), 0.0f);
  EXPECT_EQ (volume.weight ({0.0, 0.0, 0.05}), 1.0f);
  for (const float value : volume.field ().values)
    EXPECT_FALSE (std::isinf (value));
}

TEST (TsdfVolume, NoiseAveragesDown)
{
  const PinholeCamera camera = test::smallCamera ();
  const double sigma = 0.01;
  std::mt19937 random (1);
  std::normal_distribution<float> noise (0.5f, static_cast<float> (sigma));
  const auto rms = [&] (int frames) {
    TsdfVolume volume (test::cubeGrid (32, 0.01));
    for (int n = 0; n < frames; ++n)
    {
      Image<float> depth = test::wallDepth (0.5f);
      for (float& z : depth.pixels)
        z = noise (random);
      volume.integrate (depth, camera, test::frontPose ());
    }
    double sum = 0.0;
    int count = 0;
    for (int j = 8; j < 24; ++j)
      for (int i = 8; i < 24; ++i, ++count)
      {
        const VoxelGrid& grid = volume.grid ();
        const Eigen::Vector3d p = grid.center (i, j, 16);
        const double along_ray = (p - test::frontPose ().translation ()).norm () / (p.z () + 0.5);
        sum += std::pow (volume.field ().values[grid.index (i, j, 16)] / along_ray + p.z (), 2);
      }
    return std::sqrt (sum / count);
  };
  EXPECT_NEAR (rms (1), sigma, 0.15 * sigma);
  EXPECT_NEAR (rms (25), sigma / 5.0, 0.15 * sigma / 5.0);
}

TEST (TsdfVolume, TheWeightIsCappedSoThatAMovedSurfaceReplacesTheOldOne)
{
  TsdfOptions options;
  options.max_weight = 8.0;
  TsdfVolume volume (test::cubeGrid (32, 0.01), options);
  for (int n = 0; n < 100; ++n)
    volume.integrate (test::wallDepth (0.5f), test::smallCamera (), test::frontPose ());
  const Eigen::Vector3d p (0.005, 0.005, 0.0);
  EXPECT_EQ (volume.weight (p), 8.0f);
  EXPECT_NEAR (volume.sample (p)->value (), 0.0, 1e-5);
  for (int n = 0; n < 50; ++n) // what is left of the old one is (8 / 9)^50 < 0.3 %
    volume.integrate (test::wallDepth (0.55f), test::smallCamera (), test::frontPose ());
  EXPECT_EQ (volume.weight (p), 8.0f);
  EXPECT_NEAR (volume.sample (p)->value (), 0.05, 0.001);
}

TEST (TsdfVolume, WeightsOfPixels)
{
  const PinholeCamera camera = test::smallCamera ();
  TsdfVolume volume (test::cubeGrid (32, 0.01));
  TsdfPixels pixels;
  Image<float> weights (camera.width, camera.height, 0.75f);
  pixels.weights = &weights;
  volume.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels);
  weights = Image<float> (camera.width, camera.height, 0.25f);
  volume.integrate (test::wallDepth (0.54f), camera, test::frontPose (), pixels);
  const Eigen::Vector3d p (0.005, 0.005, 0.0);
  EXPECT_EQ (volume.weight (p), 1.0f);
  EXPECT_NEAR (volume.sample (p)->value (), 0.25 * 0.04, 1e-5);

  const TsdfVolume before = volume;
  for (const float nothing : {0.0f, -1.0f, nan_f, -infinity_f})
  {
    weights = Image<float> (camera.width, camera.height, nothing);
    volume.integrate (test::wallDepth (0.4f), camera, test::frontPose (), pixels);
    EXPECT_TRUE (sameState (before, volume)) << nothing;
  }
  weights = Image<float> (camera.width, camera.height, infinity_f); // as much as a voxel can have
  volume.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels);
  EXPECT_EQ (volume.weight (p), 64.0f);
  weights = Image<float> (camera.width, camera.height, std::numeric_limits<float>::denorm_min ());
  TsdfVolume faint (test::cubeGrid (32, 0.01));
  faint.integrate (test::wallDepth (0.5f), camera, test::frontPose (), pixels);
  EXPECT_NEAR (faint.sample (p)->value (), 0.0, 1e-5);
}

TEST (TsdfVolume, MasksSeparateObjects)
{
  const PinholeCamera camera = test::smallCamera ();
  Image<float> depth = test::wallDepth (0.5f);
  Image<std::uint16_t> labels (camera.width, camera.height, 1);
  for (int v = 0; v < camera.height; ++v)
    for (int u = camera.width / 2; u < camera.width; ++u)
    {
      depth.at (u, v) = 0.45f;
      labels.at (u, v) = 2;
    }
  TsdfPixels pixels;
  pixels.labels = &labels;
  const Eigen::Vector3d left (-0.055, 0.005, 0.0);
  const Eigen::Vector3d right (0.055, 0.005, 0.0);
  for (const std::uint16_t label : {1, 2})
  {
    TsdfVolume volume (test::cubeGrid (32, 0.01));
    pixels.label = label;
    volume.integrate (depth, camera, test::frontPose (), pixels);
    EXPECT_EQ (volume.weight (left), label == 1 ? 1.0f : 0.0f);
    EXPECT_EQ (volume.weight (right), label == 2 ? 1.0f : 0.0f);
  }
}

TEST (TsdfVolume, ReadingsThatAreNone)
{
  TsdfVolume volume (test::cubeGrid (32, 0.01));
  volume.integrate (test::wallDepth (0.5f), test::smallCamera (), test::frontPose ());
  const TsdfVolume before = volume;
  for (const float none : {nan_f, infinity_f, -infinity_f, 0.0f, -0.5f})
  {
    volume.integrate (test::wallDepth (none), test::smallCamera (), test::frontPose ());
    EXPECT_TRUE (sameState (before, volume)) << none;
  }
  // One of them among readings silences its pixel alone.
  for (const float none : {nan_f, infinity_f})
  {
    Image<float> depth = test::wallDepth (0.5f);
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width / 2; ++u)
        depth.at (u, v) = none;
    TsdfVolume half (test::cubeGrid (32, 0.01));
    half.integrate (depth, test::smallCamera (), test::frontPose ());
    EXPECT_EQ (half.weight ({-0.055, 0.005, 0.0}), 0.0f);
    EXPECT_EQ (half.weight ({0.055, 0.005, 0.0}), 1.0f);
  }
  // A reading however far says that all before it is free.
  TsdfVolume free (test::cubeGrid (32, 0.01));
  free.integrate (test::wallDepth (std::numeric_limits<float>::max ()), test::smallCamera (), test::frontPose ());
  EXPECT_NEAR (free.sample (Eigen::Vector3d (0.0, 0.0, 0.0))->value (), free.truncation (), 1e-6);
}

TEST (TsdfVolume, VolumesOutOfView)
{
  TsdfVolume volume (test::cubeGrid (32, 0.01));
  Eigen::Isometry3d pose = test::frontPose ();
  pose.translation ().z () = 0.5; // all voxels behind the sensor
  volume.integrate (test::wallDepth (0.5f), test::smallCamera (), pose);
  pose.translation () << 1e30, -1e200, 1e300;
  volume.integrate (test::wallDepth (0.5f), test::smallCamera (), pose);
  EXPECT_EQ (seenVoxels (volume), 0u);

  VoxelGrid voxel = test::cubeGrid (1, 0.01);
  TsdfVolume single (voxel);
  single.integrate (test::wallDepth (0.5f), test::smallCamera (), test::frontPose ());
  EXPECT_EQ (single.weights ()[0], 1.0f);
  EXPECT_FALSE (single.sample (Eigen::Vector3d (0.0, 0.0, 0.0)));
  EXPECT_TRUE (single.surfaceMesh ().empty ());
}

TEST (TsdfVolume, VoxelsOfAnySize)
{
  const PinholeCamera camera = test::smallCamera ();
  TsdfOptions options;
  options.colour = true;
  options.foreground = true;
  const Picture colours (camera.width, camera.height, {1, 2, 3});
  const Image<std::uint16_t> labels (camera.width, camera.height, 1);
  TsdfPixels pixels;
  pixels.colours = &colours;
  for (const double size : {1e-300, 1e-40, 1e-25, 1e-10, 1.0, 1e5, 1e8}) // what single precision holds, and more
  {
    TsdfVolume volume (test::cubeGrid (20, size), options);
    Eigen::Isometry3d inside = test::lookAtOrigin ({1.0, 1.0, 1.0});
    inside.translation ().setConstant (size);
    for (const Eigen::Isometry3d& pose :
         {Eigen::Isometry3d (Eigen::Isometry3d::Identity ()), test::frontPose (), inside})
    {
      volume.integrate (test::wallDepth (0.5f), camera, pose, pixels);
      volume.countForeground (test::wallDepth (0.5f), camera, pose, labels, 1);
    }
    for (std::size_t v = 0; v < volume.weights ().size (); ++v)
    {
      ASSERT_TRUE (volume.weights ()[v] >= 0.0f && volume.weights ()[v] <= 3.0f);
      ASSERT_EQ (volume.weights ()[v] > 0.0f, std::isfinite (volume.field ().values[v])) << size;
    }
  }
  EXPECT_THROW (TsdfVolume (test::cubeGrid (20, 1e9)), InvalidArgument);
}

TEST (TsdfVolume, ForegroundCounts)
{
  const PinholeCamera camera = test::smallCamera ();
  TsdfOptions options;
  options.foreground = true;
  TsdfVolume volume (test::cubeGrid (32, 0.01), options);
  const Eigen::Vector3d p (0.005, 0.005, 0.0);
  EXPECT_FALSE (volume.foregroundProbability (p));
  for (const std::uint16_t label : {7, 7, 7, 3})
  {
    const Image<std::uint16_t> labels (camera.width, camera.height, label);
    volume.countForeground (test::wallDepth (0.5f), camera, test::frontPose (), labels, 7);
  }
  EXPECT_EQ (volume.foregroundProbability (p), 0.75f);
  EXPECT_FALSE (volume.foregroundProbability ({0.005, 0.005, -0.14})); // free space belongs to nobody
  EXPECT_FALSE (volume.foregroundProbability ({9.0, 0.0, 0.0}));
  EXPECT_EQ (seenVoxels (volume), 0u); // distances are not touched

  const Image<std::uint16_t> labels (camera.width, camera.height, 7);
  TsdfVolume without (test::cubeGrid (4, 0.01));
  EXPECT_THROW (without.countForeground (test::wallDepth (0.5f), camera, test::frontPose (), labels, 7),
                InvalidArgument);
  EXPECT_FALSE (without.foregroundProbability (p));

  TsdfVolume often (test::cubeGrid (2, 0.01), options);
  const PinholeCamera pixel{1, 1, 10.0, 10.0, 0.0, 0.0};
  for (int n = 0; n < 70000; ++n)
    often.countForeground (Image<float> (1, 1, 0.5f), pixel, test::frontPose (),
                           Image<std::uint16_t> (1, 1, n % 4 ? 7 : 0), 7);
  EXPECT_NEAR (*often.foregroundProbability (Eigen::Vector3d::Zero ()), 0.75, 0.01);
}

TEST (TsdfVolume, WhatIsForgottenIsAsNeverSeen)
{
  const PinholeCamera camera = test::smallCamera ();
  TsdfVolume volume (test::cubeGrid (32, 0.01));
  const Image<float> wall = test::wallDepth (0.5f);
  volume.integrate (wall, camera, test::frontPose ());
  Image<std::uint16_t> labels (camera.width, camera.height, 0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = camera.width / 2; u < camera.width; ++u)
      labels.at (u, v) = 7;
  volume.forget (wall, camera, test::frontPose (), labels, 7);
  EXPECT_TRUE (volume.sample<double> ({-0.055, 0.005, 0.0}));
  EXPECT_FALSE (volume.sample<double> ({0.055, 0.005, 0.0}));
  EXPECT_EQ (volume.weight ({0.055, 0.005, 0.0}), 0.0f);
  EXPECT_GT (volume.weight ({0.055, 0.005, -0.14}), 0.0f); // free space stays
  volume.integrate (wall, camera, test::frontPose ());
  EXPECT_TRUE (volume.sample<double> ({0.055, 0.005, 0.0}));
  EXPECT_THROW (volume.forget (wall, camera, test::frontPose (), Image<std::uint16_t> (3, 3), 7), InvalidArgument);
}

TEST (TsdfVolume, AnyNumberOfThreadsGivesTheSameBytes)
{
  const PinholeCamera camera = test::smallCamera ();
  Picture colours (camera.width, camera.height, {10, 200, 90});
  TsdfPixels pixels;
  pixels.colours = &colours;
  TsdfOptions options;
  options.colour = true;
  std::vector<TsdfVolume> volumes;
  for (const int threads : {1, 4})
  {
    options.threads = threads;
    volumes.emplace_back (test::cubeGrid (64, 0.005), options);
    for (const auto& pose : test::posesAround (0.5))
      volumes.back ().integrate (test::renderDepth (test::sphereRay (0.1), camera, pose), camera, pose, pixels);
  }
  EXPECT_TRUE (sameState (volumes[0], volumes[1]));
  const TriangleMesh a = volumes[0].surfaceMesh ();
  const TriangleMesh b = volumes[1].surfaceMesh ();
  EXPECT_FALSE (a.empty ());
  EXPECT_TRUE (sameBytes (a.vertices, b.vertices));
  EXPECT_TRUE (sameBytes (a.triangles, b.triangles));
  EXPECT_TRUE (sameBytes (a.normals, b.normals));
  EXPECT_TRUE (sameBytes (a.colours, b.colours));
}
