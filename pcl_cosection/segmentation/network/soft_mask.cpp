// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "soft_mask.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

/** \brief First pixel whose middle is at or beyond \a edge, from 0 to \a size. */
int
firstPixel (double edge, int size)
{
  return (static_cast<int> (std::clamp (std::ceil (edge - 0.5), 0.0, static_cast<double> (size))));
}

/** \brief Two cells and how much of the second, for the middle of a pixel. */
struct Interpolation
{
  int first, second;
  float share;
};

Interpolation
interpolation (int pixel, double covered_from, double covered_to, int cells)
{
  const double at = (pixel + 0.5 - covered_from) / (covered_to - covered_from) * cells - 0.5;
  const double inside = std::clamp (at, 0.0, static_cast<double> (cells - 1));
  const int first = static_cast<int> (inside);
  return {first, std::min (first + 1, cells - 1), static_cast<float> (inside - first)};
}

float
mix (float first, float second, float share)
{
  return (first + share * (second - first));
}

} // namespace

bool
Rectangle::isProper () const
{
  return (std::isfinite (left) && std::isfinite (top) && std::isfinite (right) && std::isfinite (bottom) &&
          left < right && top < bottom);
}

double
Rectangle::intersectionOverUnion (const Rectangle& other) const
{
  const double width = std::min (right, other.right) - std::max (left, other.left);
  const double height = std::min (bottom, other.bottom) - std::max (top, other.top);
  if (width <= 0.0 || height <= 0.0)
    return (0.0);
  const double both = width * height;
  return (both / ((right - left) * (bottom - top) + (other.right - other.left) * (other.bottom - other.top) - both));
}

Rectangle
toImage (const Rectangle& in_input, const ImagePlacement& placement)
{
  const double x = static_cast<double> (placement.image_width) / placement.width;
  const double y = static_cast<double> (placement.image_height) / placement.height;
  return {(in_input.left - placement.left) * x, (in_input.top - placement.top) * y,
          (in_input.right - placement.left) * x, (in_input.bottom - placement.top) * y};
}

void
pasteMask (const SoftMask& soft, const Rectangle& box, const ImagePlacement& placement, double threshold,
           DetectedInstance& instance)
{
  instance.left = firstPixel (box.left, placement.image_width);
  instance.top = firstPixel (box.top, placement.image_height);
  const int width = firstPixel (box.right, placement.image_width) - instance.left;
  const int height = firstPixel (box.bottom, placement.image_height) - instance.top;
  const Image<float>& p = soft.probabilities;
  if (width <= 0 || height <= 0 || p.pixels.empty ())
    return;
  instance.mask = Image<std::uint8_t> (width, height, 0);
  std::vector<Interpolation> columns;
  for (int u = 0; u < width; ++u)
    columns.push_back (interpolation (instance.left + u, soft.covered.left, soft.covered.right, p.width));
  for (int v = 0; v < height; ++v)
  {
    const Interpolation row = interpolation (instance.top + v, soft.covered.top, soft.covered.bottom, p.height);
    for (int u = 0; u < width; ++u)
    {
      const Interpolation& column = columns[u];
      const float above = mix (p.at (column.first, row.first), p.at (column.second, row.first), column.share);
      const float below = mix (p.at (column.first, row.second), p.at (column.second, row.second), column.share);
      instance.mask.at (u, v) = mix (above, below, row.share) >= threshold ? 1 : 0;
    }
  }
}

} // namespace pcl::cosection
