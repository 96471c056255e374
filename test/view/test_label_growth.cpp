// Copybox_right (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Labels that end within their objects.

#include "common/temporary_folder.h"

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace pcl::cosection;

namespace {

/** \brief A box on a table, seen from above: columns 120 to 199 and rows 80 to 159. */
class LabelGrowth : public testing::Test
{
protected:
  static constexpr int image_width = 320, image_height = 240;
  static constexpr float focal_px = 285.0f, above_table_m = 0.6f; // above the table, looking straight down
  static constexpr int box_left = 120, box_right = 200, box_top = 80, box_bottom = 160;

  LabelGrowth ()
  {
    cloud_.resize (static_cast<std::size_t> (image_width) * image_height);
    cloud_.width = image_width;
    cloud_.height = image_height;
    set (0, image_width, 0, image_height, 0.0f);
    set (box_left, box_right, box_top, box_bottom, 0.1f);
  }

  void set (int from, int to, int above, int below, float height_m)
  {
    const float depth = above_table_m - height_m;
    for (int v = above; v < below; ++v)
      for (int u = from; u < to; ++u)
      {
        pcl::PointXYZL& p = cloud_.at (u, v);
        p.x = (static_cast<float> (u) - 159.5f) / focal_px * depth;
        p.y = (static_cast<float> (v) - 119.5f) / focal_px * depth;
        p.z = depth;
      }
  }

  void label (int from, int to, int above, int below)
  {
    for (int v = above; v < below; ++v)
      for (int u = from; u < to; ++u)
        cloud_.at (u, v).label = 1;
  }

  LabelledView read () const
  {
    const std::string path = folder_.file ("cloud.pcd");
    pcl::io::savePCDFileBinary (path, cloud_);
    return readPcdView (path, {});
  }

private:
  pcl::PointCloud<pcl::PointXYZL> cloud_;
  pcl::cosection::test::TemporaryFolder folder_;
};

} // namespace

TEST_F (LabelGrowth, ALabelThatIsTooSmallAllAroundGrowsAndIsSaid)
{
  label (box_left + 3, box_right - 3, box_top + 3, box_bottom - 3);
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
  label (box_left, box_right, box_top, box_bottom);
  const LabelledView view = read ();
  EXPECT_EQ (view.objects.at (1).readings, 80u * 80u);
  EXPECT_TRUE (view.warnings.empty ());
}

TEST_F (LabelGrowth, WhatIsOnTheTableIsOfTheTable)
{
  set (box_left, box_right, box_top, box_bottom, 0.002f); // a sheet within the noise
  label (box_left, box_right, box_top, box_bottom);
  EXPECT_EQ (read ().objects.at (1).readings, 80u * 80u);
}

TEST_F (LabelGrowth, NoMoreThanAMargin)
{
  label (box_left + 20, box_right - 20, box_top + 20, box_bottom - 20);
  EXPECT_LE (read ().objects.at (1).readings, 48u * 48u);
}

TEST_F (LabelGrowth, APartThatEndsMostlyInEdgesIsKept)
{
  label (box_left, box_right, box_top, box_bottom - 20);
  EXPECT_EQ (read ().objects.at (1).readings, 80u * 60u);
}
