// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/view/visibility/visibility.h"

#include <gtest/gtest.h>

#include <limits>

using namespace pcl::cosection;

namespace {

/** \brief 4 x 3 pixels that see a wall at 1 m, but for the last pixel. */
DepthView
wall ()
{
  DepthView view;
  view.camera.width = 4;
  view.camera.height = 3;
  view.camera.fx = view.camera.fy = 2.0;
  view.camera.cx = 1.5;
  view.camera.cy = 1.0;
  view.depth.assign (12, 1.0f);
  view.depth.back () = std::numeric_limits<float>::quiet_NaN ();
  return view;
}

} // namespace

TEST (Visibility, EachPixelShowsWhatItsRayMeets)
{
  const DepthView view = wall ();
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
      for (const double shift : {-0.49, 0.0, 0.49})
      {
        const auto pixel = pixelOf (view.camera, view.camera.unproject (u + shift, v - shift, 0.7));
        ASSERT_TRUE (pixel);
        EXPECT_TRUE ((*pixel == Eigen::Array2i (u, v)).all ());
      }
}

TEST (Visibility, NothingIsShownBesideTheImageOrBehindTheCamera)
{
  const DepthView view = wall ();
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d (-0.51, 1.0), Eigen::Vector2d (3.51, 1.0),
                                       Eigen::Vector2d (1.0, -0.51), Eigen::Vector2d (1.0, 2.51)})
    EXPECT_EQ (PointVisibility::Outside,
               visibilityOf (view.camera.unproject (pixel.x (), pixel.y (), 1.0), view, 0.01));
  EXPECT_EQ (PointVisibility::Outside, visibilityOf ({0.0, 0.0, -1.0}, view, 0.01));
  EXPECT_EQ (PointVisibility::Outside, visibilityOf ({0.0, 0.0, 0.0}, view, 0.01));
}

TEST (Visibility, DependsOnTheReadingAndTheMargin)
{
  const DepthView view = wall ();
  EXPECT_EQ (PointVisibility::Free, visibilityOf ({0.0, 0.0, 0.95}, view, 0.01));
  EXPECT_EQ (PointVisibility::AtSurface, visibilityOf ({0.0, 0.0, 0.95}, view, 0.1));
  EXPECT_EQ (PointVisibility::AtSurface, visibilityOf ({0.0, 0.0, 1.005}, view, 0.01));
  EXPECT_EQ (PointVisibility::Occluded, visibilityOf ({0.0, 0.0, 1.05}, view, 0.01));
  EXPECT_EQ (PointVisibility::NoReading, visibilityOf (view.camera.unproject (3.0, 2.0, 0.5), view, 0.01));
}

TEST (Visibility, OnlyPositiveFiniteDepthsAreReadings)
{
  for (const double depth :
       {0.0, -1.0, std::numeric_limits<double>::infinity (), std::numeric_limits<double>::quiet_NaN ()})
  {
    EXPECT_FALSE (isReading (depth));
    EXPECT_EQ (PointVisibility::NoReading, compareWithReading (1.0, depth, 0.1));
  }
}
