// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "calibration.h"

#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/text_scanner.h"

#include <cmath>
#include <sstream>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double largest_size_px = 32768.0;
constexpr double largest_focal_length_px = 1e6;
constexpr double shortest_focal_length = 0.05;    // of the image's size: a field of view of 169 degrees
constexpr double longest_focal_length = 100.0;    // half a degree
constexpr double farthest_principal_point = 10.0; // of the image's size: it may be cut out of a larger one

std::string
text (double a, double b)
{
  std::ostringstream out;
  out << a << " and " << b;
  return out.str ();
}

bool
isSize (double pixels)
{
  return pixels >= 1.0 && pixels <= largest_size_px && pixels == std::floor (pixels);
}

} // namespace

std::string
implausibleIntrinsics (const PinholeCamera& camera)
{
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  if (!(fx > 0.0 && fy > 0.0 && fx < largest_focal_length_px && fy < largest_focal_length_px))
    return "has focal lengths fx and fy of " + text (fx, fy) +
           " pixels; they must be positive, and less than a million";
  constexpr double farthest_px = farthest_principal_point * largest_size_px;
  if (!(std::abs (cx) <= farthest_px && std::abs (cy) <= farthest_px))
    return "has a principal point cx, cy of " + text (cx, cy) + " pixels; it must be in the image, or near it";
  if (fx < 2.0 || fy < 2.0)
    return "has focal lengths fx and fy of " + text (fx, fy) +
           "; they must be in pixels, not parts of the image's size";
  const double width = camera.width, height = camera.height;
  if (width <= 0.0 || height <= 0.0)
    return {};
  const std::string image = " for an image of " + std::to_string (camera.width) + " x " +
                            std::to_string (camera.height) + " pixels";
  if (fx < shortest_focal_length * width || fy < shortest_focal_length * height || fx > longest_focal_length * width ||
      fy > longest_focal_length * height)
    return "has focal lengths fx and fy of " + text (fx, fy) + image + "; they must be in pixels";
  if (std::abs (cx) > farthest_principal_point * width || std::abs (cy) > farthest_principal_point * height)
    return "has a principal point cx, cy of " + text (cx, cy) + image + "; it must be in the image, or near it";
  return {};
}

PinholeCamera
readCalibration (const std::string& path)
{
  const std::string bytes = readBytes (path);
  std::vector<double> numbers;
  try
  {
    TextScanner scanner (bytes);
    while (!scanner.left ().empty ())
    {
      TextScanner line (scanner.line ());
      for (std::string_view word = line.word (); !word.empty () && word[0] != '#'; word = line.word ())
        numbers.push_back (toReal (word));
    }
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": must be 'fx fy cx cy [width height]' in pixels, but " + error.what ());
  }
  if (numbers.size () != 4 && numbers.size () != 6)
    throw IoError (path + ": must be 'fx fy cx cy [width height]' in pixels, but has " +
                   std::to_string (numbers.size ()) + " numbers");
  PinholeCamera camera;
  camera.fx = numbers[0];
  camera.fy = numbers[1];
  camera.cx = numbers[2];
  camera.cy = numbers[3];
  if (numbers.size () == 6)
  {
    if (!isSize (numbers[4]) || !isSize (numbers[5]))
      throw IoError (path + ": has a width and height of " + text (numbers[4], numbers[5]) +
                     "; they must be whole numbers of pixels");
    camera.width = static_cast<int> (numbers[4]);
    camera.height = static_cast<int> (numbers[5]);
  }
  const std::string fault = implausibleIntrinsics (camera);
  if (!fault.empty ())
    throw IoError (path + ": " + fault);
  return camera;
}

} // namespace pcl::cosection
