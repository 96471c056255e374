// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Smoothed brightness of a picture, 0 to 255, to be read between pixels. The first level has the picture's
 * size, each other one half the size of the one before. */
using BrightnessLevels = std::vector<Image<float>>;

/** \brief How many levels tracking uses. */
constexpr std::size_t brightness_levels = 3;

/** \brief Radius, pixels, of the mean that the first level's brightness between pixels is. */
constexpr int brightness_reach_px = 3;

/** \brief Smooth and halve a picture; it gets fewer levels if it is too small for all. */
BrightnessLevels brightnessLevels (const Picture& picture, std::size_t levels);

/** \brief Brightness at a place within the image and how it changes per pixel. */
struct BrightnessReading
{
  float value;
  float du;
  float dv;
};

/** \brief Read between pixels. \param[in] u, v within [0, width - 1] and [0, height - 1] of an image of two pixels at
 * least each way */
BrightnessReading readBrightness (const Image<float>& image, double u, double v);

} // namespace pcl::cosection
