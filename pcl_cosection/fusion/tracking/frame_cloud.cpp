// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_cloud.h"

#include "bilateral_filter.h"
#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN ();
// A share of the depth: a larger step between pixels is an edge. Noise is not allowed for, unlike in
// smallestEdgeStep (): tracking can do without readings, and is more accurate without those that are only noisy.
constexpr float edge_step = 0.03f;
constexpr double model_sigma_voxels = 0.25; // how well a volume knows where a surface is

bool
isEdge (const Image<float>& depth, int u, int v)
{
  const float z = depth.at (u, v);
  const auto jumps = [&] (int uu, int vv) {
    return uu >= 0 && vv >= 0 && uu < depth.width && vv < depth.height &&
           std::abs (depth.at (uu, vv) - z) > edge_step * z; // not if there is no reading
  };
  return jumps (u - 1, v) || jumps (u + 1, v) || jumps (u, v - 1) || jumps (u, v + 1);
}

/** \brief 1 where all pixels that the first level's brightness is a mean of have a reliable reading, else 0. */
Image<std::uint8_t>
unmixedPixels (const Image<float>& reliable)
{
  constexpr int reach = brightness_reach_px;
  Image<std::uint8_t> unmixed (reliable.width, reliable.height);
  std::transform (reliable.pixels.begin (), reliable.pixels.end (), unmixed.pixels.begin (),
                  [] (float z) { return static_cast<std::uint8_t> (std::isfinite (z)); });
  cv::Mat view (unmixed.height, unmixed.width, CV_8U, unmixed.pixels.data ());
  cv::erode (view, view, cv::Mat::ones (2 * reach + 1, 2 * reach + 1, CV_8U));
  return unmixed;
}

} // namespace

std::vector<Eigen::Vector3f>
FrameCloud::sample (int step) const
{
  std::vector<Eigen::Vector3f> result;
  result.reserve (points.size () / (static_cast<std::size_t> (step) * step) + 1);
  for (int v = step / 2; v < camera.height; v += step)
    for (int u = step / 2; u < camera.width; u += step)
      if (std::isfinite (reliable.at (u, v)))
        result.push_back (points[static_cast<std::size_t> (v) * camera.width + u]);
  return result;
}

FrameCloud
makeFrameCloud (const RgbdFrame& frame, const PinholeCamera& camera, const DynamicFusionOptions& options)
{
  const Image<float>& depth = frame.depth;
  const bool smooth = options.smooth_depth;
  if (depth.width != camera.width || depth.height != camera.height)
    throw InvalidArgument ("the depth image must be of the camera's size");
  BilateralFilterOptions filter;
  filter.threads = options.threads;
  const Image<float> smoothed = smooth ? bilateralFilter (depth, filter) : Image<float> ();
  FrameCloud cloud;
  cloud.camera = camera;
  cloud.depth = depth;
  cloud.reliable = Image<float> (camera.width, camera.height, none);
  cloud.points.assign (depth.pixels.size (), Eigen::Vector3f::Constant (none));
  std::vector<std::size_t> readings (camera.height, 0);
  parallelFor (0, camera.height, threadsForVoxels (options.threads, depth.pixels.size ()), [&] (int v) {
    for (int u = 0; u < camera.width; ++u)
    {
      float& z = cloud.depth.at (u, v);
      if (!(z > 0.0f && z <= options.max_depth_m))
      {
        z = none;
        continue;
      }
      ++readings[v];
      cloud.points[static_cast<std::size_t> (v) * camera.width +
                   u] = camera.unproject (u, v, smooth ? smoothed.at (u, v) : z).cast<float> ();
      if (!isEdge (depth, u, v))
        cloud.reliable.at (u, v) = z;
    }
  });
  cloud.readings = std::accumulate (readings.begin (), readings.end (), std::size_t (0));
  if (frame.colour.pixels.size () == depth.pixels.size ())
  {
    cloud.brightness = brightnessLevels (frame.colour, brightness_levels);
    cloud.unmixed = unmixedPixels (cloud.reliable);
  }
  return cloud;
}

float
readingWeight (double z, double voxel_size_m)
{
  const double of_model = std::pow (model_sigma_voxels * voxel_size_m, 2);
  const double of_reading = std::pow (depthNoiseSigma (z), 2);
  return static_cast<float> (of_model / (of_model + of_reading));
}

} // namespace pcl::cosection
