// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Frames as oriented points and views, and their masks.

#include "common/message_of.h"
#include "pcl_cosection/fusion/mask_reader.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/keyframe.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr float wall_m = 2.0f, block_m = 1.0f;

/** \brief A block before a wall. */
class KeyframeTest : public testing::Test
{
protected:
  KeyframeTest () : mask_ (camera_.width, camera_.height)
  {
    frame_.stamp = 7.5;
    frame_.depth = Image<float> (camera_.width, camera_.height, wall_m);
    frame_.colour = Picture (camera_.width, camera_.height);
    for (int v = 0; v < camera_.height; ++v)
      for (int u = 0; u < camera_.width; ++u)
      {
        frame_.colour.at (u, v) = {static_cast<std::uint8_t> (u), static_cast<std::uint8_t> (v), 9};
        if (u < 20 || u >= 40 || v < 15 || v >= 35)
          continue;
        frame_.depth.at (u, v) = block_m;
        mask_.at (u, v) = 300;
      }
    T_world_camera_.translate (Eigen::Vector3d (1.0, 2.0, 3.0));
  }

  Keyframe keyframe (const KeyframeOptions& options = {}) const
  {
    return makeKeyframe (frame_, camera_, mask_, T_world_camera_, options);
  }

  const PinholeCamera camera_{64, 48, 60.0, 62.0, 31.5, 23.5};
  RgbdFrame frame_;
  Image<std::uint16_t> mask_;
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity ();
};

} // namespace

TEST_F (KeyframeTest, PointsAreOfTheirInstancesInTheSensorFrame)
{
  const Keyframe result = keyframe ();
  EXPECT_EQ (result.stamp, 7.5);
  EXPECT_TRUE (result.view.T_world_sensor.isApprox (T_world_camera_));
  ASSERT_EQ (result.points.size (), 2u);
  const std::vector<OrientedPoint>& block = result.points.at (300);
  EXPECT_GT (block.size (), 200u);
  EXPECT_LE (block.size (), 400u);
  for (const auto& [id, points] : result.points)
    for (const OrientedPoint& point : points)
    {
      EXPECT_NEAR (point.position.z (), id == 0 ? wall_m : block_m, 1e-6);
      EXPECT_LT ((point.normal + Eigen::Vector3f::UnitZ ()).norm (), 1e-3) << "towards the camera";
      const Eigen::Vector2d pixel = camera_.project (point.position.cast<double> ());
      EXPECT_EQ (std::lround (pixel.x ()), point.colour[0]);
      EXPECT_EQ (std::lround (pixel.y ()), point.colour[1]);
    }
}

TEST_F (KeyframeTest, OnlyTheBackgroundIsThinned)
{
  KeyframeOptions all, few;
  all.background_step = 1;
  few.background_step = 4;
  const Keyframe dense = keyframe (all), sparse = keyframe (few);
  EXPECT_EQ (dense.points.at (300).size (), sparse.points.at (300).size ());
  EXPECT_NEAR (static_cast<double> (dense.points.at (0).size ()) / static_cast<double> (sparse.points.at (0).size ()),
               16.0, 4.0);
  EXPECT_EQ (dense.view.depth, sparse.view.depth) << "free space is that of all pixels";
}

TEST_F (KeyframeTest, WhatIsTooFarOrNoDepthIsNone)
{
  frame_.depth.at (0, 0) = 0.0f;
  frame_.depth.at (1, 0) = -1.0f;
  frame_.depth.at (2, 0) = std::numeric_limits<float>::infinity ();
  KeyframeOptions options;
  options.max_depth_m = 1.5;
  const Keyframe near = keyframe (options);
  EXPECT_EQ (near.points.count (0), 0u);
  EXPECT_EQ (near.points.count (300), 1u);
  for (int v = 0; v < camera_.height; ++v)
    for (int u = 0; u < camera_.width; ++u)
      EXPECT_EQ (std::isnan (near.view.at (u, v)), mask_.at (u, v) == 0) << u << ' ' << v;
  options.max_depth_m = 10.0;
  const DepthView view = makeDepthView (frame_.depth, camera_, T_world_camera_, options);
  for (int u = 0; u < 3; ++u)
    EXPECT_TRUE (std::isnan (view.at (u, 0))) << u;
  EXPECT_EQ (view.at (3, 0), wall_m);
}

TEST_F (KeyframeTest, WithoutMaskAllIsBackgroundAndWithoutColourNone)
{
  mask_ = {};
  frame_.colour = {};
  const Keyframe result = keyframe ();
  ASSERT_EQ (result.points.size (), 1u);
  for (const OrientedPoint& point : result.points.at (0))
    EXPECT_EQ (point.colour, (std::array<std::uint8_t, 3>{0, 0, 0}));
}

/** \brief A square in front of a wall, and masks of it. */
TEST (Masks, WhatReachesBeyondItsObjectIsOfWhatItShows)
{
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  RgbdFrame frame;
  frame.depth = Image<float> (64, 48, 2.0f);
  const auto square = [] (int border) {
    Image<std::uint16_t> mask (64, 48, 0);
    for (int v = 14 - border; v < 34 + border; ++v)
      for (int u = 22 - border; u < 42 + border; ++u)
        mask.at (u, v) = 7;
    return mask;
  };
  for (std::size_t n = 0; n < frame.depth.pixels.size (); ++n)
    if (square (0).pixels[n] == 7)
      frame.depth.pixels[n] = 1.0f;
  for (const int border : {0, 3})
  {
    MaskReader reader ([&] (const RgbdFrame&) { return square (border); }, camera);
    const auto mask = reader.read (frame);
    ASSERT_TRUE (mask);
    EXPECT_EQ (mask->pixels, square (0).pixels) << border;
    const std::vector<std::string> warnings = reader.warnings ();
    ASSERT_EQ (warnings.size (), border > 0 ? 1u : 0u);
    if (border > 0)
      EXPECT_NE (warnings[0].find ("41 % of the pixels of label 7 of the masks are on other surfaces"),
                 std::string::npos)
          << warnings[0];
  }
}

TEST_F (KeyframeTest, WrongSizesAndOptionsAreRefused)
{
  mask_ = Image<std::uint16_t> (32, 24);
  EXPECT_NE (messageOf<InvalidArgument> ([&] { keyframe (); }).find ("the mask has 32 x 24 pixels, the camera 64 x 48"),
             std::string::npos);
  mask_ = {};
  frame_.depth = Image<float> (64, 47, 1.0f);
  EXPECT_NE (messageOf<InvalidArgument> ([&] { keyframe (); }).find ("the depth image has 64 x 47"), std::string::npos);
  frame_.depth = Image<float> (64, 48, 1.0f);
  frame_.depth.pixels.resize (100);
  EXPECT_NE (messageOf<InvalidArgument> ([&] { keyframe (); }).find ("holds 100 pixels"), std::string::npos);
  KeyframeOptions options;
  options.max_depth_m = std::nan ("");
  EXPECT_THROW (options.validate (), InvalidArgument);
  options = {};
  options.background_step = 0;
  EXPECT_THROW (options.validate (), InvalidArgument);
}
