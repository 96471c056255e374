// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Labels that reach beyond their objects, onto what is behind or before them.

#include "common/temporary_folder.h"

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

using namespace pcl::cosection;

namespace {

constexpr int width = 120, height = 90;
constexpr float focal = 150.0f;
constexpr float wall_m = 1.2f, object_m = 0.8f, occluder_m = 0.6f;

/** \brief An object before a wall, columns 40 to 79 and rows 20 to 69. */
class StrayPatches : public testing::Test
{
protected:
  StrayPatches ()
  {
    cloud_.resize (static_cast<std::size_t> (width) * height);
    cloud_.width = width;
    cloud_.height = height;
    set (0, width, 0, height, wall_m, 0);
    set (40, 80, 20, 70, object_m, 1);
  }

  void set (int left, int right, int top, int bottom, float depth_m, std::uint32_t label)
  {
    for (int v = top; v < bottom; ++v)
      for (int u = left; u < right; ++u)
      {
        pcl::PointXYZL& p = cloud_.at (u, v);
        p.x = (static_cast<float> (u) - 59.5f) / focal * depth_m;
        p.y = (static_cast<float> (v) - 44.5f) / focal * depth_m;
        p.z = depth_m;
        p.label = label;
      }
  }

  void label (int left, int right, int top, int bottom, std::uint32_t label)
  {
    for (int v = top; v < bottom; ++v)
      for (int u = left; u < right; ++u)
        cloud_.at (u, v).label = label;
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
