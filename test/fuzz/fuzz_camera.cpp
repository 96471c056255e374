// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as the file of a sequence's camera, by a name of text and by one of JSON.

#include "fuzz_target.h"
#include "memory_file.h"

#include "pcl_cosection/sequence/camera_file.h"

#include <pcl/cosection/common/error.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

void
check (const CameraFile& file)
{
  constexpr int largest_size_px = 32768;
  const PinholeCamera& camera = file.camera;
  fuzz::require ((camera.width > 0) == (camera.height > 0), "there is a width and a height, or neither");
  for (const int size : {camera.width, camera.height})
    fuzz::require (size >= 0 && size <= largest_size_px, "images are not absurdly large");
  fuzz::require (!file.depth_scale || (std::isfinite (*file.depth_scale) && *file.depth_scale > 0.0),
                 "the scale of the depth is positive");
}

bool
loads (const std::string& path)
{
  CameraFile file;
  try
  {
    file = readCameraFile (path);
  }
  catch (const IoError& error)
  {
    fuzz::requireMessage (error.what ());
    return (false);
  }
  check (file);
  return (true);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {
      "525.0 525.0 319.5 239.5\n",
      "# fx fy cx cy width height\n525 525 319.5 239.5 640 480",
      "5.25e+02 0 319.5\r\n0 525.0 239.5\r\n0 0 1\r\n",
      "577.87 0.00 319.5 0.00\n0.00 577.87 239.5 0.00\n0.00 0.00 1.00 0.00\n0.00 0.00 0.00 1.00\n",
      R"({"width": 640, "height": 480, "intrinsic_matrix": [525.0, 0, 0, 0, 525.0, 0, 319.5, 239.5, 1]})",
      R"({"camera": {"w": 1200, "h": 680, "fx": 600.0, "fy": 600.0, "cx": 599.5, "cy": 339.5, "scale": 6553.5}})",
      R"({"width": 640, "height": 480, "fx": 525.0, "fy": 525.0, "ppx": 319.5, "ppy": 239.5})",
      R"({"intrinsic_matrix": [525.0, 0, 319.5, 0, 525.0, 239.5, 0, 0, 1]})",
      R"({"cx": 325.26, "cy": 242.05, "depth_scale": 0.1, "fx": 572.41, "fy": 573.57, "height": 480, "width": 640})",
      R"({"K": [525, 0.5, 319.5, 0, 525, 239.5, 0, 0, 1], "depth_scale": 1})",
      R"({"0": {"cam_K": [572.4, 0, 325.3, 0, 573.6, 242.0, 0, 0, 1], "depth_scale": 1.0, "view_level": 0},
 "1": {"cam_K": [572.4, 0, 325.3, 0, 573.6, 242.0, 0, 0, 1], "depth_scale": 1.0}})"};
}

std::vector<std::string>
fuzz::dictionary ()
{
  constexpr std::size_t deep = 1 << 14; // brackets in each other
  return {std::string (deep, '[') + std::string (deep, ']'),
          "#",
          "0 0 1\n",
          "640 480",
          "\"fx\":",
          "\"cy\":",
          "\"width\":",
          "\"height\":",
          "\"depth_scale\":",
          "\"intrinsic_matrix\":",
          "\"cam_K\":",
          "\"K\":",
          "[525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]",
          "{\"cam_K\": [",
          "[",
          "]",
          "{",
          "}",
          ",",
          ":",
          "\"",
          "null",
          "true",
          "-1.5",
          "1e-320",
          "\\ud800"};
}

bool
fuzz::accepts (const std::string& input)
{
  static NamedMemoryFile file;
  file.set (input);
  const bool is_text = loads (file.path (".txt"));
  return (loads (file.path (".json")) || is_text);
}
