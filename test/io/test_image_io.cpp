// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/image_io.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

using namespace pcl::cosection;

namespace
{

const float none = std::numeric_limits<float>::quiet_NaN ();

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
