// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Labels that reach beyond their objects, onto what is behind or before them.

#include "labelled_image.h"

#include <limits>
#include <string>

using namespace pcl::cosection;

namespace {

constexpr int width = 120, height = 90;
constexpr float focal = 150.0f;
constexpr float wall_m = 1.2f, object_m = 0.8f, occluder_m = 0.6f;

/** \brief An object before a wall, columns 40 to 79 and rows 20 to 69. */
class StrayPatches : public pcl::cosection::test::LabelledImage
{
protected:
  StrayPatches () : LabelledImage (width, height, focal)
  {
    set (0, width, 0, height, wall_m, 0);
    set (40, 80, 20, 70, object_m, 1);
  }

  void set (int left, int right, int top, int bottom, float depth_m, std::uint32_t of_label)
  {
    LabelledImage::set (left, right, top, bottom, depth_m);
    label (left, right, top, bottom, of_label);
  }
};

} // namespace

TEST_F (StrayPatches, WhatIsOnTheWallIsOfTheWall)
{
  label (80, 82, 20, 70, 1);
  const LabelledView view = read ();
  EXPECT_EQ (view.objects.at (1).readings, 40u * 50u);
  EXPECT_TRUE (view.warnings.empty ());
}

TEST_F (StrayPatches, AShiftedLabelIsSaid)
{
  label (80, 90, 20, 70, 1);
  label (40, 50, 20, 70, 0);
  const LabelledView view = read ();
  EXPECT_EQ (view.objects.at (1).readings, 30u * 50u);
  ASSERT_EQ (view.warnings.size (), 1u);
  EXPECT_NE (view.warnings[0].find ("25 % of the points of label 1 are on other surfaces"), std::string::npos)
      << view.warnings[0];
}

/** \brief The near wall of a bowl meets the table, and no other surface: it is no part of that. */
TEST_F (StrayPatches, LabelsThatWereFoundInTheReadingsAreKept)
{
  label (80, 90, 20, 70, 1);
  const LabelledView view = read (true);
  EXPECT_EQ (view.objects.at (1).readings, 50u * 50u);
  EXPECT_TRUE (view.warnings.empty ());
}

TEST_F (StrayPatches, WhatIsOnAnOccluderIsOfTheOccluder)
{
  set (30, 60, 40, 60, occluder_m, 2);
  label (50, 60, 40, 60, 1);
  const LabelledView view = read ();
  EXPECT_EQ (view.objects.at (1).readings, 40u * 50u - 20u * 20u);
  EXPECT_EQ (view.objects.at (2).readings, 30u * 20u);
}

TEST_F (StrayPatches, BothPartsOfWhatIsSeenBesideAnOccluderAreKept)
{
  set (0, width, 30, 40, occluder_m, 2);
  EXPECT_EQ (read ().objects.at (1).readings, 40u * 40u);
}

TEST_F (StrayPatches, APartThatHardlyBordersOnAnythingIsKept)
{
  constexpr float none = std::numeric_limits<float>::quiet_NaN ();
  set (88, 112, 28, 52, none, 0);
  set (90, 110, 30, 50, wall_m, 1); // as far as the wall, but only one pixel beside it tells
  set (110, 111, 40, 41, wall_m, 0);
  EXPECT_EQ (read ().objects.at (1).readings, 40u * 50u + 20u * 20u);
}

TEST_F (StrayPatches, WithoutALabelAroundItNothingIsMoved)
{
  label (0, width, 0, height, 1);
  EXPECT_EQ (read ().objects.at (1).readings, static_cast<std::size_t> (width) * height);
}

TEST_F (StrayPatches, MissingReadingsAtEdgesHideNoEdge)
{
  set (0, width, 80, height, object_m + 0.008f, 0); // a bar lies on something, and has a shadow behind it
  set (40, 80, 76, 80, object_m, 1);
  set (38, 82, 75, 76, std::numeric_limits<float>::quiet_NaN (), 0);
  EXPECT_EQ (read ().objects.at (1).readings, 40u * 50u + 40u * 4u);
}

TEST_F (StrayPatches, SmearedEdgesAreEdges)
{
  set (90, 110, 30, 50, object_m, 1);
  for (int n = 1; n < 10; ++n) // no step is larger than a slope may be
  {
    const float depth_m = object_m + 0.024f * static_cast<float> (n);
    set (109 + n, 110 + n, 30, 50, depth_m, 0);
    set (90, 110, 49 + n, 50 + n, depth_m, 0);
    set (90, 110, 30 - n, 31 - n, depth_m, 0);
  }
  EXPECT_EQ (read ().objects.at (1).readings, 40u * 50u + 20u * 20u);
}
