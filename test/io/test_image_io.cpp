// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/message_of.h"
#include "common/temporary_folder.h"

#include "pcl_cosection/io/image_io.h"
#include <pcl/cosection/common/error.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

using namespace pcl::cosection;

namespace {

const float none = std::numeric_limits<float>::quiet_NaN ();

/** \brief The bytes of a number, least significant first. */
template <typename Number>
std::string
bytesOf (Number number)
{
  std::string bytes (sizeof number, '\0');
  std::memcpy (&bytes[0], &number, sizeof number);
  return bytes;
}

std::string
exrAttribute (const std::string& name, const std::string& type, const std::string& value)
{
  return name + '\0' + type + '\0' + bytesOf (static_cast<std::int32_t> (value.size ())) + value;
}

/** \brief An EXR without compression, one pixel wide: blue, green and red of each row. */
std::string
plainExr (const std::vector<std::array<float, 3>>& rows)
{
  const auto height = static_cast<std::int32_t> (rows.size ());
  std::string channels;
  for (const char* name : {"B", "G", "R"})
    channels += name + std::string (1, '\0') + bytesOf (std::int32_t (2)) + std::string (4, '\0') + bytesOf (1) +
                bytesOf (1);
  const std::string window = bytesOf (0) + bytesOf (0) + bytesOf (0) + bytesOf (height - 1);
  std::string bytes = "\x76\x2f\x31\x01" + bytesOf (2);
  bytes += exrAttribute ("channels", "chlist", channels + '\0');
  bytes += exrAttribute ("compression", "compression", std::string (1, '\0'));
  bytes += exrAttribute ("dataWindow", "box2i", window) + exrAttribute ("displayWindow", "box2i", window);
  bytes += exrAttribute ("lineOrder", "lineOrder", std::string (1, '\0'));
  bytes += exrAttribute ("pixelAspectRatio", "float", bytesOf (1.0f));
  bytes += exrAttribute ("screenWindowCenter", "v2f", bytesOf (0.0f) + bytesOf (0.0f));
  bytes += exrAttribute ("screenWindowWidth", "float", bytesOf (1.0f)) + '\0';
  constexpr std::size_t block = 8 + 12;
  for (std::size_t n = 0; n < rows.size (); ++n)
    bytes += bytesOf (std::uint64_t (bytes.size () + 8 * (rows.size () - n) + block * n));
  for (std::int32_t n = 0; n < height; ++n)
  {
    bytes += bytesOf (n) + bytesOf (12);
    for (const float value : rows[static_cast<std::size_t> (n)])
      bytes += bytesOf (value);
  }
  return bytes;
}

} // namespace

TEST (ImageIo, DepthRoundTrip)
{
  const test::TemporaryFolder folder;
  Image<float> depth (3, 2);
  depth.pixels = {0.5f, none, 1.2345f, 70.0f, -1.0f, std::numeric_limits<float>::infinity ()};
  saveDepthImage (depth, folder.file ("a.png"));
  Image<float> read = loadDepthImage (folder.file ("a.png"));
  ASSERT_EQ (read.width, 3);
  ASSERT_EQ (read.height, 2);
  EXPECT_FLOAT_EQ (read.pixels[0], 0.5f);
  EXPECT_TRUE (std::isnan (read.pixels[1]));
  EXPECT_NEAR (read.pixels[2], 1.2345f, 5.1e-4);
  for (const int n : {3, 4, 5}) // too far for 16 bits, and no depths
    EXPECT_TRUE (std::isnan (read.pixels[n]));
  saveDepthImage (depth, folder.file ("a.exr"));
  read = loadDepthImage (folder.file ("a.exr"));
  EXPECT_EQ (read.pixels[2], 1.2345f);
  EXPECT_EQ (read.pixels[3], 70.0f);
  for (const int n : {1, 4, 5})
    EXPECT_TRUE (std::isnan (read.pixels[n]));
  EXPECT_THROW (saveDepthImage (depth, folder.file ("a.jpg")), InvalidArgument);
}

TEST (ImageIo, MasksOfSeveralChannelsAndPalettes)
{
  const test::TemporaryFolder folder;
  const cv::Mat grey = (cv::Mat_<std::uint8_t> (2, 2) << 0, 255, 7, 7);
  cv::Mat rgb, rgba;
  cv::cvtColor (grey, rgb, cv::COLOR_GRAY2BGR);
  cv::cvtColor (grey, rgba, cv::COLOR_GRAY2BGRA);
  rgba.at<cv::Vec4b> (0, 0)[3] = 0;
  cv::imwrite (folder.file ("rgb.png"), rgb);
  cv::imwrite (folder.file ("rgba.png"), rgba);
  const std::vector<std::uint16_t> expected = {0, 255, 7, 7};
  EXPECT_EQ (loadMaskImage (folder.file ("rgb.png")).pixels, expected);
  EXPECT_EQ (loadMaskImage (folder.file ("rgba.png")).pixels, expected);

  // Two pixels, of the second and the first colour of a palette: black, dark red.
  const unsigned char palette[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
      0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x03, 0x00, 0x00, 0x00, 0xc3, 0xfc, 0x8f, 0xb8, 0x00, 0x00, 0x00,
      0x06, 0x50, 0x4c, 0x54, 0x45, 0x00, 0x00, 0x00, 0x80, 0x00, 0x00, 0x44, 0x52, 0xa2, 0x4f, 0x00, 0x00, 0x00,
      0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x00, 0x00, 0x00, 0x05, 0x00, 0x02, 0xd1, 0x66,
      0x33, 0x78, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  test::writeFile (folder.file ("palette.png"),
                   std::string (reinterpret_cast<const char*> (palette), sizeof (palette)));
  EXPECT_EQ (loadMaskImage (folder.file ("palette.png")).pixels, (std::vector<std::uint16_t>{1, 0}));
}

TEST (ImageIo, MasksWhoseChunksAreWholeMayBeDamaged)
{
  const test::TemporaryFolder folder;
  const std::vector<std::vector<unsigned char>> damaged = {
      {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
       0x00, 0x04, 0x00, 0x00, 0x00, 0x04, 0x08, 0x00, 0x00, 0x00, 0x00, 0x8c, 0x9a, 0xc1, 0xa2, 0x00, 0x00, 0x00,
       0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x02, 0x00, 0x00, 0x07, 0x00, 0x04, 0x76, 0x49,
       0xe3, 0x28, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82}, // fewer pixels than it says
      {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
       0x52, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x04, 0x08, 0x00, 0x00, 0x00, 0x00, 0x8c,
       0x9a, 0xc1, 0xa2, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82}, // none
      {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x01,
       0x00, 0x00, 0x00, 0x00, 0x08, 0x00, 0x10, 0x06, 0x00, 0x00, 0x00, 0xc3, 0x51, 0xa2, 0x59, 0x00, 0x00, 0x00,
       0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x80, 0x01, 0x00, 0x00, 0x0a, 0x00, 0x01, 0x7f, 0x80,
       0x74, 0x5e, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82}}; // a gibibyte, it says
  for (const std::vector<unsigned char>& bytes : damaged)
  {
    test::writeFile (folder.file ("m.png"), std::string (bytes.begin (), bytes.end ()));
    EXPECT_THROW (loadMaskImage (folder.file ("m.png")), IoError);
  }
}

TEST (ImageIo, MaskAndColourRoundTrip)
{
  const test::TemporaryFolder folder;
  Image<std::uint16_t> mask (2, 2);
  mask.pixels = {0, 1, 254, 255};
  saveMaskImage (mask, folder.file ("m.png"));
  EXPECT_EQ (loadMaskImage (folder.file ("m.png")).pixels, mask.pixels);
  mask.pixels[0] = 60000;
  EXPECT_THROW (saveMaskImage (mask, folder.file ("m.png")), InvalidArgument);
  saveMaskImage (mask, folder.file ("w.png"), true);
  EXPECT_EQ (loadMaskImage (folder.file ("w.png")).pixels, mask.pixels);
  Picture picture (2, 1);
  picture.pixels = {{1, 2, 3}, {250, 128, 0}};
  saveColourImage (picture, folder.file ("c.png"));
  EXPECT_EQ (loadColourImage (folder.file ("c.png")).pixels, picture.pixels);
  EXPECT_THROW (loadMaskImage (folder.file ("c.png")), IoError);
  EXPECT_THROW (loadDepthImage (folder.file ("c.png")), IoError);
}

TEST (ImageIo, DamageIsAnError)
{
  const test::TemporaryFolder folder;
  Image<float> depth (40, 50);
  Picture colour (40, 50);
  for (std::size_t n = 0; n < depth.pixels.size (); ++n)
  {
    depth.pixels[n] = 1.0f + 0.001f * static_cast<float> (n * 7919 % 1013);
    colour.pixels[n][1] = static_cast<std::uint8_t> (n * 7919 % 251);
  }
  saveDepthImage (depth, folder.file ("whole.png"));
  saveDepthImage (depth, folder.file ("whole.exr"));
  saveColourImage (colour, folder.file ("whole.jpg"));
  for (const std::string extension : {".png", ".exr", ".jpg"})
  {
    testing::internal::CaptureStderr (); // the libraries that decode images write to it
    const std::string bytes = test::readFile (folder.file ("whole" + extension));
    const std::string path = folder.file ("cut" + extension);
    const auto load = [&] {
      if (extension == ".jpg")
        loadColourImage (path);
      else
        loadDepthImage (path);
    };
    for (std::size_t size = 0; size < bytes.size (); size += 1 + size / 16)
    {
      test::writeFile (path, bytes.substr (0, size));
      EXPECT_NE (test::messageOf<IoError> (load).find (path), std::string::npos);
    }
    test::writeFile (path, bytes.substr (0, bytes.size () - 1));
    EXPECT_THROW (load (), IoError) << path;
    const std::string said = testing::internal::GetCapturedStderr ();
    if (extension != ".exr") // OpenCV prints a line about an EXR file that is cut
      EXPECT_EQ (said, "") << path;
  }
  testing::internal::CaptureStderr ();
  std::string bytes = test::readFile (folder.file ("whole.png"));
  for (std::size_t at = 8; at < bytes.size (); at += 37)
  {
    std::string damaged = bytes;
    damaged[at] ^= 0x10;
    test::writeFile (folder.file ("flipped.png"), damaged);
    EXPECT_THROW (loadDepthImage (folder.file ("flipped.png")), IoError) << at;
  }
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "");
}

TEST (ImageIo, DepthMayBeInThreeEqualChannels)
{
  const test::TemporaryFolder folder;
  test::writeFile (folder.file ("equal.exr"), plainExr ({{1.5f, 1.5f, 1.5f}, {0.0f, 0.0f, 0.0f}, {2.5f, 2.5f, 2.5f}}));
  const Image<float> depth = loadDepthImage (folder.file ("equal.exr"));
  ASSERT_EQ (depth.width, 1);
  ASSERT_EQ (depth.height, 3);
  EXPECT_EQ (depth.pixels[0], 1.5f);
  EXPECT_TRUE (std::isnan (depth.pixels[1]));
  EXPECT_EQ (depth.pixels[2], 2.5f);
  test::writeFile (folder.file ("colour.exr"), plainExr ({{1.5f, 1.5f, 1.0f}}));
  EXPECT_THROW (loadDepthImage (folder.file ("colour.exr")), IoError);
}

TEST (ImageIo, ImagesThatAreWholeAreNotCalledDamaged)
{
  const test::TemporaryFolder folder;
  for (const int height : {1, 15, 16, 17, 240}) // blocks of an EXR have 16 rows
  {
    saveDepthImage (Image<float> (7, height, 1.5f), folder.file ("a.exr"));
    EXPECT_EQ (loadDepthImage (folder.file ("a.exr")).height, height);
    saveColourImage (Picture (7, height), folder.file ("a.jpg"));
    EXPECT_EQ (loadColourImage (folder.file ("a.jpg")).height, height);
  }
}

TEST (ImageIo, WhatIsNoImageIsSaid)
{
  const test::TemporaryFolder folder;
  std::ofstream (folder.file ("a.png")) << "no image";
  std::ofstream (folder.file ("empty.png"));
  for (const char* name : {"a.png", "empty.png", "nowhere.png"})
    EXPECT_THROW (loadDepthImage (folder.file (name)), IoError) << name;
  EXPECT_THROW (saveColourImage (Picture (2, 2), folder.file ("no/a.png")), IoError);
  EXPECT_THROW (saveColourImage (Picture (2, 2), folder.file ("a.unknown")), IoError);
  EXPECT_THROW (saveColourImage (Picture (), folder.file ("nothing.png")), IoError);
}
