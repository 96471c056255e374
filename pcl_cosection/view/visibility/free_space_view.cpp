// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "free_space_view.h"

#include "depth_edges.h"
#include "visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double margin_voxels = 3.0;
constexpr double margin_sigmas = 3.0;

/** \brief filterDepth () row by row, so that the compiler vectorises it. */
template <typename Best>
std::vector<float>
filterWindows (const std::vector<float>& image, const PinholeCamera& camera, int radius, const PixelRegion& region,
               Best&& best)
{
  const auto width = static_cast<std::size_t> (camera.width);
  std::vector<float> columns (image.size ()); // best of each window's column
  const int first = std::max (0, region.left - radius);
  const int last = std::min (camera.width, region.right + radius);
  for (int v = region.top; v < region.bottom; ++v)
  {
    float* out = columns.data () + v * width;
    const float* row = image.data () + v * width;
    std::copy (row + first, row + std::max (first, last), out + first);
    for (int w = std::max (0, v - radius); w <= std::min (camera.height - 1, v + radius); ++w)
    {
      const float* other = image.data () + w * width;
      for (int u = first; u < last; ++u)
        out[u] = best (out[u], other[u]);
    }
  }
  std::vector<float> filtered (image.size ());
  for (int v = region.top; v < region.bottom; ++v)
  {
    float* out = filtered.data () + v * width;
    const float* row = columns.data () + v * width;
    std::copy (row + region.left, row + std::max (region.left, region.right), out + region.left);
    for (int shift = -radius; shift <= radius; ++shift)
      for (int u = std::max (region.left, -shift); u < std::min (region.right, camera.width - shift); ++u)
        out[u] = best (out[u], row[u + shift]);
  }
  return filtered;
}

} // namespace

double
leastFreeSpaceMargin (double voxel_size_m)
{
  return margin_voxels * voxel_size_m;
}

double
freeSpaceMargin (const DepthView& view, double depth_m, double voxel_size_m)
{
  return std::max (leastFreeSpaceMargin (voxel_size_m),
                   margin_sigmas * depthNoiseSigma (depth_m, view.working_range_m));
}

std::vector<float>
filterDepth (const std::vector<float>& image, const PinholeCamera& camera, int radius, bool maximum,
             const PixelRegion& region)
{
  return maximum ? filterWindows (image, camera, radius, region, [] (float a, float b) { return a < b ? b : a; })
                 : filterWindows (image, camera, radius, region, [] (float a, float b) { return b < a ? b : a; });
}

FreeSpaceView::FreeSpaceView (DepthView view, std::vector<int> bodies)
    : view_ (std::move (view))
    , bodies_ (std::move (bodies))
    , edge_ (view_.depth.size (), 0)
{
  const int width = view_.camera.width;
  const int height = view_.camera.height;
  const auto compare = [&] (int u, int v, int u2, int v2) {
    const float a = view_.at (u, v);
    const float b = view_.at (u2, v2);
    if (!isReading (a) || !isReading (b))
      return;
    const double near = std::min (a, b);
    if (std::abs (a - b) > smallestEdgeStep (near, view_.working_range_m))
    {
      edge_[static_cast<std::size_t> (v) * width + u] = 1;
      edge_[static_cast<std::size_t> (v2) * width + u2] = 1;
    }
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
    {
      if (u + 1 < width)
        compare (u, v, u + 1, v);
      if (v + 1 < height)
        compare (u, v, u, v + 1);
    }

  std::vector<float> depth (view_.depth);
  for (float& z : depth)
    if (!isReading (z))
      z = 0.0f;
  const PixelRegion all = wholeImage (view_.camera);
  opened_ = filterDepth (filterDepth (depth, view_.camera, 1, false, all), view_.camera, 1, true, all);
}

std::vector<float>
FreeSpaceView::freeDepth (const std::vector<float>& depth, int body, double voxel_size_m, float no_reading,
                          const PixelRegion& region) const
{
  std::vector<float> free (depth.size (), no_reading);
  for (int v = region.top; v < region.bottom; ++v)
    for (int u = region.left; u < region.right; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * view_.camera.width + u;
      const float z = depth[pixel];
      if (isReading (z))
        free[pixel] = showsOther (pixel, body) ? z : static_cast<float> (z - freeSpaceMargin (view_, z, voxel_size_m));
    }
  return free;
}

} // namespace pcl::cosection
