// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "bilateral_filter.h"

#include "pcl_cosection/common/multiversion.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/require.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr float no_reading = -1e9f; ///< far from every reading
constexpr float cut_off = 4.5f;     ///< half the square of three sigma
constexpr int max_window_px = 99;

/** \brief exp (-x) for 0 <= x <= 10, to a relative 2e-5; a few instructions that go into vectors. */
PCL_COSECTION_INLINE float
expOfMinus (float x)
{
  constexpr float log2_e = 1.44269504f;
  constexpr int bias = 127;
  constexpr int mantissa_bits = 23;
  const float power = 16.0f - x * log2_e; // positive, so that truncation is the floor
  const auto whole = static_cast<std::int32_t> (power);
  const float f = power - static_cast<float> (whole);
  // 2^f for 0 <= f < 1 by its Taylor series.
  const float fraction = 1.0f + f * (0.693147181f +
                                     f * (0.240226507f +
                                          f * (0.0555041087f +
                                               f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
  const std::int32_t bits = (whole - 16 + bias) << mantissa_bits;
  float scale;
  std::memcpy (&scale, &bits, sizeof (scale));
  return scale * fraction;
}

/** \brief Add what one pixel of the window says to a row: weights and weighted differences. */
PCL_COSECTION_MULTIVERSION void
addNeighbours (const float* __restrict centres, const float* __restrict neighbours, int count, float precision,
               float space_weight, float* __restrict weights, float* __restrict differences)
{
  for (int i = 0; i < count; ++i)
  {
    const float difference = neighbours[i] - centres[i];
    const float x = difference * difference * precision;
    const float near_weight = (x < cut_off ? space_weight : 0.0f);
    const float w = near_weight * expOfMinus (std::min (x, cut_off));
    weights[i] += w;
    differences[i] += w * difference;
  }
}

/** \brief The image with a border, and where nothing is known, of no_reading. */
Image<float>
padded (const Image<float>& depth, int border)
{
  Image<float> image (depth.width + 2 * border, depth.height + 2 * border, no_reading);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      if (const float z = depth.at (u, v); isReading (z))
        image.at (u + border, v + border) = z;
  return image;
}

} // namespace

void
BilateralFilterOptions::validate () const
{
  if (window_px < 1 || window_px > max_window_px || window_px % 2 == 0)
    throw InvalidArgument ("window_px must be odd, from 1 to 99");
  if (!isPositive (sigma_depth_m))
    throw InvalidArgument ("sigma_depth_m must be positive");
  if (!isPositive (sigma_space_px))
    throw InvalidArgument ("sigma_space_px must be positive");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

Image<float>
bilateralFilter (const Image<float>& depth, const BilateralFilterOptions& options)
{
  options.validate ();
  if (depth.width < 0 || depth.height < 0 ||
      depth.pixels.size () != static_cast<std::size_t> (depth.width) * depth.height)
    throw InvalidArgument ("bilateral filter: the image must have as many pixels as its size says");
  const int radius = options.window_px / 2;
  const int width = depth.width;
  const Image<float> readings = padded (depth, radius);
  const auto precision = static_cast<float> (0.5 / (options.sigma_depth_m * options.sigma_depth_m));
  std::vector<float> space_weights (options.window_px);
  for (int d = -radius; d <= radius; ++d)
    space_weights[d + radius] = static_cast<float> (
        std::exp (-0.5 * d * d / (options.sigma_space_px * options.sigma_space_px)));

  Image<float> filtered = depth;
  const std::size_t work = depth.pixels.size () * options.window_px; // comparable with voxels
  parallelChunks (0, depth.height, threadsForVoxels (options.threads, work), [&] (int first, int last) {
    std::vector<float> weights (width);
    std::vector<float> differences (width);
    for (int v = first; v < last; ++v)
    {
      std::fill (weights.begin (), weights.end (), 0.0f);
      std::fill (differences.begin (), differences.end (), 0.0f);
      const float* centres = &readings.at (radius, v + radius);
      for (int dv = 0; dv < options.window_px; ++dv)
        for (int du = 0; du < options.window_px; ++du)
          addNeighbours (centres, &readings.at (du, v + dv), width, precision, space_weights[du] * space_weights[dv],
                         weights.data (), differences.data ());
      for (int u = 0; u < width; ++u)
        if (centres[u] > 0.0f)
          filtered.at (u, v) = centres[u] + differences[u] / weights[u];
    }
  });
  return filtered;
}

} // namespace pcl::cosection
