// Copybox_right (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Labels that end within their objects.

#include "labelled_image.h"

#include <string>

using namespace pcl::cosection;

namespace {

/** \brief A box on a table, seen from above: columns 120 to 199 and rows 80 to 159. */
class LabelGrowth : public pcl::cosection::test::LabelledImage
{
protected:
  static constexpr int image_width = 320, image_height = 240;
  static constexpr float above_table_m = 0.6f; // looking straight down
  static constexpr int box_left = 120, box_right = 200, box_top = 80, box_bottom = 160;

  LabelGrowth () : LabelledImage (image_width, image_height, 285.0f)
  {
    set (0, image_width, 0, image_height, above_table_m);
    set (box_left, box_right, box_top, box_bottom, above_table_m - 0.1f);
  }
};

} // namespace

TEST_F (LabelGrowth, ALabelThatIsTooSmallAllAroundGrowsAndIsSaid)
{
  label (box_left + 3, box_right - 3, box_top + 3, box_bottom - 3, 1);
  const LabelledView view = read ();
  // What is beside depth edges may be of either side; labels grow by diamonds, without three pixels in each corner.
  EXPECT_EQ (view.objects.at (1).readings, 78u * 78u - 4u * 3u);
  ASSERT_EQ (view.warnings.size (), 1u);
  EXPECT_NE (view.warnings[0].find ("10 % of the points of label 1 were around it, without a label, on the same "
                                    "surface: the label may be too small"),
             std::string::npos)
      << view.warnings[0];
}

TEST_F (LabelGrowth, AnExactLabelIsKept)
{
  label (box_left, box_right, box_top, box_bottom, 1);
  const LabelledView view = read ();
  EXPECT_EQ (view.objects.at (1).readings, 80u * 80u);
  EXPECT_TRUE (view.warnings.empty ());
}

TEST_F (LabelGrowth, WhatIsOnTheTableIsOfTheTable)
{
  set (box_left, box_right, box_top, box_bottom, above_table_m - 0.002f); // a sheet within the noise
  label (box_left, box_right, box_top, box_bottom, 1);
  EXPECT_EQ (read ().objects.at (1).readings, 80u * 80u);
}

TEST_F (LabelGrowth, NoMoreThanAMargin)
{
  label (box_left + 20, box_right - 20, box_top + 20, box_bottom - 20, 1);
  EXPECT_LE (read ().objects.at (1).readings, 48u * 48u);
}

TEST_F (LabelGrowth, APartThatEndsMostlyInEdgesIsKept)
{
  label (box_left, box_right, box_top, box_bottom - 20, 1);
  EXPECT_EQ (read ().objects.at (1).readings, 80u * 60u);
}
