// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ignored_area.h"

#include "option_values.h"

#include "pcl_cosection/io/mask_image.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

void
declareIgnoredArea (CLI::App& app, GivenIgnoredArea& given)
{
  OptionGroup input (app, "Input");
  input.add ("--ignore-region X,Y,W,H", given.regions,
             "Leave out these pixels: column and row of a rectangle's corner, its width and height; repeatable");
  input.add ("--ignore-mask FILE", given.mask, "Also those that are not 0 in this PNG");
}

IgnoredArea
ignoredArea (const GivenIgnoredArea& given)
{
  IgnoredArea area;
  area.mask = given.mask;
  if (given.regions.empty ())
    return (area);
  const auto regions = parseTuples<4> (given.regions);
  constexpr double largest = 1e6;
  const auto isRegion = [] (const std::array<double, 4>& r) {
    return (r[2] >= 1.0 && r[3] >= 1.0 && std::all_of (r.begin (), r.end (), [] (double n) {
              return (n >= 0.0 && n <= largest && n == std::floor (n));
            }));
  };
  if (!regions || !std::all_of (regions->begin (), regions->end (), isRegion))
    throw UsageError ("--ignore-region must be x,y,width,height in whole pixels, such as 0,400,640,80");
  for (const std::array<double, 4>& r : *regions)
    area.regions.push_back (
        {static_cast<int> (r[0]), static_cast<int> (r[1]), static_cast<int> (r[2]), static_cast<int> (r[3])});
  return (area);
}

Image<std::uint8_t>
ignoredPixels (const IgnoredArea& area, int width, int height)
{
  Image<std::uint8_t> ignored (width, height, 0);
  for (const auto& [left, top, columns, rows] : area.regions)
  {
    if (left + columns > width || top + rows > height)
      throw UsageError ("a region of --ignore-region is not within the images, which are " + std::to_string (width) +
                        " x " + std::to_string (height));
    for (int v = top; v < top + rows; ++v)
      for (int u = left; u < left + columns; ++u)
        ignored.at (u, v) = 1;
  }
  if (area.mask.empty ())
    return (ignored);
  const Image<std::uint16_t> mask = loadMaskImage (area.mask);
  if (mask.width != width || mask.height != height)
    throw IoError (area.mask + ": is " + std::to_string (mask.width) + " x " + std::to_string (mask.height) +
                   ", the images are " + std::to_string (width) + " x " + std::to_string (height));
  for (std::size_t i = 0; i < mask.pixels.size (); ++i)
    if (mask.pixels[i] != 0)
      ignored.pixels[i] = 1;
  return (ignored);
}
