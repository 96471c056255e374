// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "ignored_pixels.h"

#include "arguments.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/image_io.h>

using namespace pcl::cosection;

Image<std::uint8_t>
ignoredPixels (const PinholeCamera& camera, const std::vector<std::array<double, 4>>& regions, const std::string& mask)
{
  if (regions.empty () && mask.empty ())
    return {};
  Image<std::uint8_t> ignored (camera.width, camera.height, 0);
  for (const auto& [x, y, width, height] : regions)
  {
    if (x + width > camera.width || y + height > camera.height)
      throw UsageError ("a region of --ignore-region is not within the images, which are " + std::to_string (camera.width) + " x " +
                        std::to_string (camera.height));
    for (int v = static_cast<int> (y); v < static_cast<int> (y + height); ++v)
      for (int u = static_cast<int> (x); u < static_cast<int> (x + width); ++u)
        ignored.at (u, v) = 1;
  }
  if (mask.empty ())
    return ignored;
  const Image<std::uint16_t> read = loadMaskImage (mask);
  if (read.width != camera.width || read.height != camera.height)
    throw IoError (mask + ": is " + std::to_string (read.width) + " x " + std::to_string (read.height) + ", the images are " +
                   std::to_string (camera.width) + " x " + std::to_string (camera.height));
  for (std::size_t n = 0; n < read.pixels.size (); ++n)
    if (read.pixels[n] != 0)
      ignored.pixels[n] = 1;
  return ignored;
}
