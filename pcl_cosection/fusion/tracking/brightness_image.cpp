// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "brightness_image.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int smallest_side = 16; // of a level

cv::Mat
viewOf (Image<float>& image)
{
  return {image.height, image.width, CV_32F, image.pixels.data ()};
}

} // namespace

BrightnessLevels
brightnessLevels (const Picture& picture, std::size_t levels)
{
  BrightnessLevels result (1, Image<float> (picture.width, picture.height));
  for (std::size_t n = 0; n < picture.pixels.size (); ++n)
  {
    const auto& rgb = picture.pixels[n];
    result[0].pixels[n] = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
  }
  cv::Mat first = viewOf (result[0]);
  cv::GaussianBlur (first, first, cv::Size (5, 5), 1.0);
  while (result.size () < levels && std::min (result.back ().width, result.back ().height) >= 2 * smallest_side)
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

BrightnessReading
readBrightness (const Image<float>& image, double u, double v)
{
  const int i = std::min (image.width - 2, static_cast<int> (u));
  const int j = std::min (image.height - 2, static_cast<int> (v));
  const auto a = static_cast<float> (u - i);
  const auto b = static_cast<float> (v - j);
  const float* upper = &image.at (i, j);
  const float* lower = upper + image.width;
  const float left = upper[0] + b * (lower[0] - upper[0]), right = upper[1] + b * (lower[1] - upper[1]);
  const float above = upper[0] + a * (upper[1] - upper[0]), below = lower[0] + a * (lower[1] - lower[0]);
  return {left + a * (right - left), right - left, below - above};
}

} // namespace pcl::cosection
