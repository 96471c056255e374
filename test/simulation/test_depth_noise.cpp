// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace pcl::cosection;

namespace {

const PinholeCamera camera{200, 150, 250.0, 250.0, 99.5, 74.5};

/** \brief A wall at \a z, turned about the vertical by \a angle, and its normals. */
struct Wall
{
  explicit Wall (double z, double angle = 0.0) : depth (camera.width, camera.height), normals (depth.pixels.size ())
  {
    const Eigen::Vector3d n (std::sin (angle), 0.0, -std::cos (angle));
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        depth.at (u, v) = static_cast<float> (n.z () * z / n.dot (camera.unproject (u, v, 1.0)));
        normals[static_cast<std::size_t> (v) * camera.width + u] = n.cast<float> ();
      }
  }

  Image<float> depth;
  std::vector<Eigen::Vector3f> normals;
};

DepthNoise
only ()
{
  DepthNoise none;
  none.disparity_sigma_px = none.disparity_step_px = none.lateral_sigma_px = none.edge_dropout = none.dropout = 0.0;
  none.grazing_begin_rad = none.grazing_end_rad = M_PI_2;
  none.shadows = false;
  none.max_m = 1e3;
  none.min_m = 0.0;
  return none;
}

double
missingShare (const Image<float>& image)
{
  return static_cast<double> (
             std::count_if (image.pixels.begin (), image.pixels.end (), [] (float z) { return !std::isfinite (z); })) /
         static_cast<double> (image.pixels.size ());
}

double
deviation (const Image<float>& measured, const Image<float>& truth)
{
  double sum = 0.0;
  for (std::size_t n = 0; n < truth.pixels.size (); ++n)
    sum += std::pow (measured.pixels[n] - truth.pixels[n], 2);
  return std::sqrt (sum / static_cast<double> (truth.pixels.size ()));
}

} // namespace

TEST (DepthNoise, NoneLeavesTheDepth)
{
  const Wall wall (1.3, 0.3);
  const Image<float> measured = measureDepth (wall.depth, wall.normals, camera, only (), 1, 0);
  EXPECT_EQ (missingShare (measured), 0.0);
  EXPECT_LE (deviation (measured, wall.depth), 1e-6);
}

TEST (DepthNoise, AxialNoiseGrowsWithTheSquareOfTheDepth)
{
  DepthNoise noise = only ();
  noise.disparity_sigma_px = 0.06;
  for (const double z : {0.7, 1.4, 2.8})
  {
    const Wall wall (z);
    const double expected = z * z / (camera.fx * noise.baseline_m) * noise.disparity_sigma_px;
    EXPECT_NEAR (deviation (measureDepth (wall.depth, wall.normals, camera, noise, 1, 0), wall.depth) / expected, 1.0,
                 0.05);
  }
}

TEST (DepthNoise, DisparityIsQuantised)
{
  DepthNoise noise = only ();
  noise.disparity_step_px = 0.125;
  const Wall wall (2.0, 0.6);
  const Image<float> measured = measureDepth (wall.depth, wall.normals, camera, noise, 1, 0);
  std::set<float> values (measured.pixels.begin (), measured.pixels.end ());
  EXPECT_LE (values.size (), 100u);
  for (const float z : values)
  {
    const double steps = camera.fx * noise.baseline_m / z / noise.disparity_step_px;
    EXPECT_NEAR (steps, std::round (steps), 1e-4);
  }
}

TEST (DepthNoise, LateralNoiseMovesEdgesByAPixelOrTwo)
{
  Wall wall (1.0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 100; u < camera.width; ++u)
      wall.depth.at (u, v) = 2.0f;
  DepthNoise noise = only ();
  noise.lateral_sigma_px = 0.5;
  const Image<float> measured = measureDepth (wall.depth, wall.normals, camera, noise, 1, 0);
  int moved = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const bool other = std::abs (measured.at (u, v) - wall.depth.at (u, v)) > 0.5;
      moved += other;
      EXPECT_TRUE (!other || std::abs (u - 99.5) < 3.0) << u;
      EXPECT_TRUE (std::abs (measured.at (u, v) - 1.0f) < 1e-6 ||
                   std::abs (measured.at (u, v) - 2.0f) < 1e-6); // nothing between
    }
  EXPECT_GT (moved, camera.height / 20);
}

TEST (DepthNoise, GrazingReadingsFail)
{
  DepthNoise noise = only ();
  noise.grazing_begin_rad = 1.2;
  noise.grazing_end_rad = 1.4;
  const auto missing = [&] (double angle) {
    Wall wall (1.0);
    const Eigen::Vector3f n (static_cast<float> (std::sin (angle)), 0.0f, static_cast<float> (-std::cos (angle)));
    Image<float> depth = wall.depth;
    std::vector<Eigen::Vector3f> normals (wall.normals.size (), n);
    const Image<float> measured = measureDepth (depth, normals, camera, noise, 1, 0);
    int failed = 0, seen = 0;
    for (int v = 70; v < 80; ++v)
      for (int u = 95; u < 105; ++u, ++seen)
        failed += !std::isfinite (measured.at (u, v));
    return static_cast<double> (failed) / seen;
  };
  EXPECT_EQ (missing (1.1), 0.0);
  EXPECT_NEAR (missing (1.3), 0.5, 0.2);
  EXPECT_EQ (missing (1.5), 1.0);
}

TEST (DepthNoise, EdgesAndSomeOthersDropOut)
{
  Wall wall (1.0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 100; u < camera.width; ++u)
      wall.depth.at (u, v) = 2.0f;
  DepthNoise noise = only ();
  noise.edge_dropout = 0.5;
  Image<float> measured = measureDepth (wall.depth, wall.normals, camera, noise, 1, 0);
  EXPECT_NEAR (missingShare (measured) * camera.width, 1.0, 0.2); // half of two columns
  noise.edge_dropout = 0.0;
  noise.dropout = 0.1;
  EXPECT_NEAR (missingShare (measureDepth (wall.depth, wall.normals, camera, noise, 1, 0)), 0.1, 0.01);
  noise.dropout = 0.0;
  noise.max_m = 1.5;
  EXPECT_NEAR (missingShare (measureDepth (wall.depth, wall.normals, camera, noise, 1, 0)), 0.5, 1e-9);
}

TEST (DepthNoise, WhatTheProjectorDoesNotLightIsMissing)
{
  Wall wall (2.0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 80; u < 120; ++u)
      wall.depth.at (u, v) = 1.0f;
  DepthNoise noise = only ();
  noise.shadows = true;
  const Image<float> measured = measureDepth (wall.depth, wall.normals, camera, noise, 1, 0);
  // The projector is on the right, so the shadow is left of the object, as wide as the disparities differ.
  const double width = camera.fx * noise.baseline_m * (1.0 / 1.0 - 1.0 / 2.0);
  for (int v = 0; v < camera.height; v += 30)
  {
    int missing = 0;
    for (int u = 0; u < camera.width; ++u)
      if (!std::isfinite (measured.at (u, v)))
      {
        ++missing;
        EXPECT_TRUE (u < 80 && u > 80 - width - 2) << u;
      }
    EXPECT_NEAR (missing, width, 1.5);
  }
}

TEST (DepthNoise, DependsOnSeedAndFrameAlone)
{
  const Wall wall (1.5, 0.4);
  const auto measure = [&] (std::uint64_t seed, std::uint64_t frame) {
    Image<float> image = measureDepth (wall.depth, wall.normals, camera, DepthNoise (), seed, frame);
    for (float& z : image.pixels)
      z = std::isfinite (z) ? z : 0.0f;
    return image.pixels;
  };
  EXPECT_EQ (measure (1, 3), measure (1, 3));
  EXPECT_NE (measure (1, 3), measure (2, 3));
  EXPECT_NE (measure (1, 3), measure (1, 4));
}

TEST (DepthNoise, WrongParametersAreRefused)
{
  const auto refused = [] (auto&& change) {
    DepthNoise noise;
    change (noise);
    EXPECT_THROW (noise.validate (), InvalidArgument);
  };
  refused ([] (DepthNoise& n) { n.baseline_m = 0.0; });
  refused ([] (DepthNoise& n) { n.disparity_sigma_px = -1.0; });
  refused ([] (DepthNoise& n) { n.dropout = 1.5; });
  refused ([] (DepthNoise& n) {
    n.grazing_begin_rad = 1.56;
    n.grazing_end_rad = 1.2;
  });
  refused ([] (DepthNoise& n) { n.max_m = n.min_m; });
  refused ([] (DepthNoise& n) { n.lateral_sigma_px = std::nan (""); });
}
