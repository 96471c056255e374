// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "camera_of_images.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double largest_size_px = 32768.0;
constexpr double largest_focal_length_px = 1e6;
constexpr double shortest_focal_length = 0.05;    // of the image's size: a field of view of 169 degrees
constexpr double longest_focal_length = 100.0;    // half a degree
constexpr double farthest_principal_point = 10.0; // of the image's size: it may be cut out of a larger one

} // namespace

std::string
sizeText (int width, int height)
{
  return std::to_string (width) + " x " + std::to_string (height) + " pixels";
}

std::string
pairText (double a, double b)
{
  std::ostringstream out;
  out << a << " and " << b;
  return out.str ();
}

std::string
implausibleIntrinsics (const PinholeCamera& camera)
{
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  if (!(fx > 0.0 && fy > 0.0 && fx < largest_focal_length_px && fy < largest_focal_length_px))
    return "has focal lengths fx and fy of " + pairText (fx, fy) +
           " pixels; they must be positive, and less than a million";
  constexpr double farthest_px = farthest_principal_point * largest_size_px;
  if (!(std::abs (cx) <= farthest_px && std::abs (cy) <= farthest_px))
    return "has a principal point cx, cy of " + pairText (cx, cy) + " pixels; it must be in the image, or near it";
  if (fx < 2.0 || fy < 2.0)
    return "has focal lengths fx and fy of " + pairText (fx, fy) +
           "; they must be in pixels, not parts of the image's size";
  const double width = camera.width, height = camera.height;
  if (width <= 0.0 || height <= 0.0)
    return {};
  const std::string image = " for an image of " + sizeText (camera.width, camera.height);
  if (fx < shortest_focal_length * width || fy < shortest_focal_length * height || fx > longest_focal_length * width ||
      fy > longest_focal_length * height)
    return "has focal lengths fx and fy of " + pairText (fx, fy) + image + "; they must be in pixels";
  if (std::abs (cx) > farthest_principal_point * width || std::abs (cy) > farthest_principal_point * height)
    return "has a principal point cx, cy of " + pairText (cx, cy) + image + "; it must be in the image, or near it";
  return {};
}

double
offCentre (const PinholeCamera& camera, const ImageSize& image)
{
  return std::max (std::abs ((camera.cx + 0.5) / image.width - 0.5), std::abs ((camera.cy + 0.5) / image.height - 0.5));
}

PinholeCamera
scaled (const PinholeCamera& camera, const ImageSize& from, const ImageSize& to)
{
  const double x = static_cast<double> (to.width) / from.width, y = static_cast<double> (to.height) / from.height;
  return {to.width, to.height, x * camera.fx, y * camera.fy, x * (camera.cx + 0.5) - 0.5, y * (camera.cy + 0.5) - 0.5};
}

} // namespace pcl::cosection
