// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/temporary_folder.h"

#include "pcl_cosection/io/image_io.h"
#include <pcl/cosection/common/image.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief A folder to write a small sequence into. */
class SequenceFolder
{
public:
  std::string path (const std::string& name = "") const
  {
    return name.empty () ? folder_.file ("sequence") : folder_.file ("sequence/" + name);
  }

  /** \brief A path in the folder, whose parent folders are created. */
  std::string newPath (const std::string& name) const
  {
    std::filesystem::create_directories (std::filesystem::path (path (name)).parent_path ());
    return path (name);
  }

  void text (const std::string& name, const std::string& content) const { writeFile (newPath (name), content); }

  /** \brief Write depth that identifies its frame: depthOf (frame, width, height). */
  void depth (const std::string& name, int frame, double scale = 1000.0, int width = 8, int height = 6) const
  {
    saveDepthImage (depthOf (frame, width, height), newPath (name), scale);
  }

  /** \brief Write colour that identifies its frame: red is the frame, green the column, blue the row. */
  void colour (const std::string& name, int frame, int width = 8, int height = 6) const
  {
    saveColourImage (colourOf (frame, width, height), newPath (name));
  }

  static Image<float> depthOf (int frame, int width = 8, int height = 6)
  {
    Image<float> depth (width, height);
    for (std::size_t n = 0; n < depth.pixels.size (); ++n)
      depth.pixels[n] = 1.0f + 0.1f * static_cast<float> (frame) + 0.001f * static_cast<float> (n);
    depth.pixels[1] = std::numeric_limits<float>::quiet_NaN ();
    return depth;
  }

  static Picture colourOf (int frame, int width = 8, int height = 6)
  {
    Picture picture (width, height);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        picture.at (u, v) = {static_cast<std::uint8_t> (frame), static_cast<std::uint8_t> (u),
                             static_cast<std::uint8_t> (v)};
    return picture;
  }

  /** \brief Write the frames \a numbers in the Co-Fusion layout, with calibration and colour. */
  void coFusion (const std::vector<int>& numbers) const
  {
    text ("calibration.txt", "10 11 3.5 2.5 8 6\n");
    for (const int number : numbers)
    {
      depth ("depth/Depth" + fourDigits (number) + ".png", number);
      colour ("colour/Color" + fourDigits (number) + ".png", number);
    }
  }

  static std::string fourDigits (int number)
  {
    const std::string digits = std::to_string (number);
    return std::string (digits.size () < 4 ? 4 - digits.size () : 0, '0') + digits;
  }

private:
  TemporaryFolder folder_;
};

/** \brief Expect depths equal within half a unit, and missing in the same pixels. */
inline void
expectSameDepth (const Image<float>& expected, const Image<float>& actual, double unit_m)
{
  ASSERT_EQ (expected.width, actual.width);
  ASSERT_EQ (expected.height, actual.height);
  for (std::size_t n = 0; n < expected.pixels.size (); ++n)
  {
    ASSERT_EQ (std::isnan (expected.pixels[n]), std::isnan (actual.pixels[n])) << n;
    if (std::isnan (expected.pixels[n]))
      continue;
    ASSERT_NEAR (expected.pixels[n], actual.pixels[n], 0.5 * unit_m + 1e-6) << n;
  }
}

inline bool
mentions (const std::vector<std::string>& lines, const std::string& words)
{
  for (const std::string& line : lines)
    if (line.find (words) != std::string::npos)
      return true;
  return false;
}

} // namespace pcl::cosection::test
