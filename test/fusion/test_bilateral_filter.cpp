// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/fusion/tracking/bilateral_filter.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

const float nan_depth = std::numeric_limits<float>::quiet_NaN ();

Image<float>
noisyPlane (double sigma_m)
{
  std::mt19937 generator (5);
  std::normal_distribution<float> noise (0.0f, static_cast<float> (sigma_m));
  Image<float> depth (90, 61);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.at (u, v) = 1.2f + 0.001f * static_cast<float> (u) + noise (generator);
  return depth;
}

/** \brief The definition, as it is written down. */
double
filteredPixel (const Image<float>& depth, const BilateralFilterOptions& options, int u, int v)
{
  const int radius = options.window_px / 2;
  double sum = 0.0;
  double weights = 0.0;
  for (int y = std::max (0, v - radius); y <= std::min (depth.height - 1, v + radius); ++y)
    for (int x = std::max (0, u - radius); x <= std::min (depth.width - 1, u + radius); ++x)
    {
      const double range = (depth.at (x, y) - depth.at (u, v)) / options.sigma_depth_m;
      if (!(depth.at (x, y) > 0.0f) || std::isinf (depth.at (x, y)) || std::abs (range) > 3.0)
        continue;
      const double space = std::hypot (x - u, y - v) / options.sigma_space_px;
      const double w = std::exp (-0.5 * (range * range + space * space));
      sum += w * depth.at (x, y);
      weights += w;
    }
  return sum / weights;
}

} // namespace

TEST (BilateralFilter, FollowsItsDefinition)
{
  Image<float> depth = noisyPlane (0.03);
  for (int n = 0; n < 90; ++n)
    depth.at (n, (7 * n) % 61) = (n % 2 ? nan_depth : 0.0f);
  for (const int window_px : {1, 3, 7, 11})
  {
    BilateralFilterOptions options;
    options.window_px = window_px;
    const auto filtered = bilateralFilter (depth, options);
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width; ++u)
        if (depth.at (u, v) > 0.0f)
        {
          EXPECT_NEAR (filtered.at (u, v), filteredPixel (depth, options, u, v), 2e-6) << u << " " << v;
        }
  }
}

TEST (BilateralFilter, AConstantStays)
{
  const Image<float> depth (50, 40, 1.37f);
  for (const float z : bilateralFilter (depth).pixels)
    EXPECT_EQ (z, 1.37f);
}

TEST (BilateralFilter, AStepStays)
{
  Image<float> depth (50, 40, 1.0f);
  for (int v = 0; v < 40; ++v)
    for (int u = 25; u < 50; ++u)
      depth.at (u, v) = 1.15f;
  EXPECT_EQ (bilateralFilter (depth).pixels, depth.pixels);
}

TEST (BilateralFilter, NoiseIsReducedAndNothingShifted)
{
  const Image<float> depth = noisyPlane (0.005);
  const auto filtered = bilateralFilter (depth);
  double before = 0.0;
  double after = 0.0;
  double shift = 0.0;
  for (int v = 0; v < depth.height; ++v)
    for (int u = 3; u < depth.width - 3; ++u) // where the window is cut off, a slope is not symmetric
    {
      const double truth = 1.2 + 0.001 * u;
      before += std::pow (depth.at (u, v) - truth, 2);
      after += std::pow (filtered.at (u, v) - truth, 2);
      shift += filtered.at (u, v) - depth.at (u, v);
    }
  EXPECT_LT (std::sqrt (after), 0.3 * std::sqrt (before));
  EXPECT_LT (std::abs (shift) / static_cast<double> (depth.pixels.size ()), 1e-4);
}

TEST (BilateralFilter, HolesStayAndSayNothing)
{
  const float infinity = std::numeric_limits<float>::infinity ();
  Image<float> depth (30, 20, 2.0f);
  depth.at (4, 5) = nan_depth;
  depth.at (0, 0) = 0.0f;
  depth.at (29, 19) = infinity;
  depth.at (12, 7) = -1.0f;
  const auto filtered = bilateralFilter (depth);
  EXPECT_TRUE (std::isnan (filtered.at (4, 5)));
  EXPECT_EQ (filtered.at (0, 0), 0.0f);
  EXPECT_EQ (filtered.at (29, 19), infinity);
  EXPECT_EQ (filtered.at (12, 7), -1.0f);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      if (depth.at (u, v) == 2.0f)
      {
        EXPECT_EQ (filtered.at (u, v), 2.0f);
      }
  for (const float z : bilateralFilter (Image<float> (8, 8, nan_depth)).pixels)
    EXPECT_TRUE (std::isnan (z));
}

TEST (BilateralFilter, AnImageMayBeSmallerThanTheWindow)
{
  EXPECT_TRUE (bilateralFilter (Image<float> ()).pixels.empty ());
  EXPECT_EQ (bilateralFilter (Image<float> (1, 1, 0.7f)).pixels, std::vector<float> (1, 0.7f));
  EXPECT_EQ (bilateralFilter (Image<float> (2, 3, 0.7f)).pixels, std::vector<float> (6, 0.7f));
}

TEST (BilateralFilter, ThreadsChangeNothing)
{
  const Image<float> depth = noisyPlane (0.02);
  BilateralFilterOptions options;
  options.threads = 1;
  const auto one = bilateralFilter (depth, options);
  for (const int threads : {2, 5})
  {
    options.threads = threads;
    EXPECT_EQ (bilateralFilter (depth, options).pixels, one.pixels);
  }
}

TEST (BilateralFilter, RefusesWhatIsNotValid)
{
  const Image<float> depth (10, 10, 1.0f);
  for (const int window_px : {-1, 0, 4, 101})
  {
    BilateralFilterOptions options;
    options.window_px = window_px;
    EXPECT_THROW (bilateralFilter (depth, options), InvalidArgument) << window_px;
  }
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN (), std::numeric_limits<double>::infinity ()})
  {
    BilateralFilterOptions options;
    options.sigma_depth_m = bad;
    EXPECT_THROW (bilateralFilter (depth, options), InvalidArgument) << bad;
    options = {};
    options.sigma_space_px = bad;
    EXPECT_THROW (bilateralFilter (depth, options), InvalidArgument) << bad;
  }
  BilateralFilterOptions options;
  options.threads = -1;
  EXPECT_THROW (bilateralFilter (depth, options), InvalidArgument);
  Image<float> torn = depth;
  torn.pixels.pop_back ();
  EXPECT_THROW (bilateralFilter (torn), InvalidArgument);
}
