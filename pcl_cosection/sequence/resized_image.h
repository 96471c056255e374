// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {

/** \brief Whether images have the same ratio of width to height, but for half a percent, by which that of ScanNet's
 * colour and depth differs. */
inline bool
haveSameShape (int width, int height, int other_width, int other_height)
{
  constexpr double tolerance = 0.005;
  const double one = static_cast<double> (width) * other_height, other = static_cast<double> (height) * other_width;
  return std::abs (one - other) <= tolerance * std::max (one, other);
}

/** \brief The nearest pixels of an image of the same view in another resolution. */
template <typename Pixel>
Image<Pixel>
resized (const Image<Pixel>& image, int width, int height)
{
  Image<Pixel> result (width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      result.at (u, v) = image.at (static_cast<int> ((2LL * u + 1) * image.width / (2LL * width)),
                                   static_cast<int> ((2LL * v + 1) * image.height / (2LL * height)));
  return result;
}

} // namespace pcl::cosection
