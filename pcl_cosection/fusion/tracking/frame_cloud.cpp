// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_cloud.h"

#include "bilateral_filter.h"
#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN ();
// A share of the depth: a larger step between pixels is an edge. Noise is not allowed for, unlike in
// smallestEdgeStep (): tracking can do without readings, and is more accurate without those that are only noisy.
constexpr float edge_step = 0.03f;
constexpr double model_sigma_voxels = 0.25; // how well a volume knows where a surface is
constexpr int smallest_side = 16;           // of a level of brightness
constexpr int brightness_reach_px = 3;      // of the mean that the first level's brightness between pixels is

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

cv::Mat
viewOf (Image<float>& image)
{
  return {image.height, image.width, CV_32F, image.pixels.data ()};
}

BrightnessLevels
brightnessLevels (const Picture& picture)
{
  BrightnessLevels result (1, Image<float> (picture.width, picture.height));
  for (std::size_t n = 0; n < picture.pixels.size (); ++n)
  {
    const auto& rgb = picture.pixels[n];
    result[0].pixels[n] = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
  }
  cv::Mat first = viewOf (result[0]);
  cv::GaussianBlur (first, first, cv::Size (5, 5), 1.0);
  while (result.size () < brightness_levels &&
         std::min (result.back ().width, result.back ().height) >= 2 * smallest_side)
  {
    Image<float>& last = result.back ();
    Image<float> next (last.width / 2, last.height / 2);
    cv::Mat half = viewOf (next);
    // Means of 2 x 2 pixels, so that the middle of a pixel stays the middle of a pixel.
    cv::Mat whole = viewOf (last) (cv::Rect (0, 0, 2 * next.width, 2 * next.height));
    cv::resize (whole, half, half.size (), 0.0, 0.0, cv::INTER_AREA);
    cv::GaussianBlur (half, half, cv::Size (3, 3), 0.7);
    result.push_back (std::move (next));
  }
  return result;
}

/** \brief 1 where all pixels that the first level's brightness is a mean of have a reliable reading, else 0. */
Image<std::uint8_t>
unmixedPixels (const Image<float>& reliable)
{
  constexpr int window = 2 * brightness_reach_px + 1;
  Image<std::uint8_t> unmixed (reliable.width, reliable.height);
  std::transform (reliable.pixels.begin (), reliable.pixels.end (), unmixed.pixels.begin (),
                  [] (float z) { return static_cast<std::uint8_t> (std::isfinite (z)); });
  cv::Mat view (unmixed.height, unmixed.width, CV_8U, unmixed.pixels.data ());
  cv::erode (view, view, cv::Mat::ones (window, window, CV_8U));
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

std::vector<Eigen::Vector3f>
FrameCloud::pointsOf (const LabelImage& labels, std::uint16_t label) const
{
  std::vector<Eigen::Vector3f> result;
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (labels.pixels[n] == label && std::isfinite (reliable.pixels[n]))
      result.push_back (points[n]);
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
  parallelFor (0, camera.height, threadsForVoxels (options.threads, depth.pixels.size ()), [&] (int v) {
    for (int u = 0; u < camera.width; ++u)
    {
      float& z = cloud.depth.at (u, v);
      if (!(z > 0.0f && z <= options.max_depth_m))
      {
        z = none;
        continue;
      }
      cloud.points[static_cast<std::size_t> (v) * camera.width +
                   u] = camera.unproject (u, v, smooth ? smoothed.at (u, v) : z).cast<float> ();
      if (!isEdge (depth, u, v))
        cloud.reliable.at (u, v) = z;
    }
  });
  cloud.readings = static_cast<std::size_t> (
      std::count_if (cloud.depth.pixels.begin (), cloud.depth.pixels.end (), [] (float z) { return !std::isnan (z); }));
  if (frame.colour.pixels.size () == depth.pixels.size ())
  {
    cloud.brightness = brightnessLevels (frame.colour);
    cloud.unmixed = unmixedPixels (cloud.reliable);
  }
  return cloud;
}

BrightnessReading
readBrightness (const Image<float>& image, const Eigen::Vector2d& pixel)
{
  const int i = std::min (image.width - 2, static_cast<int> (pixel.x ()));
  const int j = std::min (image.height - 2, static_cast<int> (pixel.y ()));
  const auto a = static_cast<float> (pixel.x () - i), b = static_cast<float> (pixel.y () - j);
  const float* upper = &image.at (i, j);
  const float* lower = upper + image.width;
  const float left = upper[0] + b * (lower[0] - upper[0]), right = upper[1] + b * (lower[1] - upper[1]);
  const float above = upper[0] + a * (upper[1] - upper[0]), below = lower[0] + a * (lower[1] - lower[0]);
  return {left + a * (right - left), right - left, below - above};
}

bool
isWithin (const Image<float>& image, const Eigen::Vector2d& pixel)
{
  return pixel.x () >= 0.0 && pixel.y () >= 0.0 && pixel.x () <= image.width - 1.0 && pixel.y () <= image.height - 1.0;
}

float
readingWeight (double z, double voxel_size_m)
{
  const double of_model = std::pow (model_sigma_voxels * voxel_size_m, 2);
  const double of_reading = std::pow (depthNoiseSigma (z), 2);
  return static_cast<float> (of_model / (of_model + of_reading));
}

} // namespace pcl::cosection
