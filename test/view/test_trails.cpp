// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Mixed pixels in unorganised clouds: readings between an object and what is behind it.

#include "common/temporary_folder.h"

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

using namespace pcl::cosection;

namespace {

class Trails : public testing::Test
{
protected:
  template <typename PointT>
  LabelledView read (const pcl::PointCloud<PointT>& cloud, const PcdViewOptions& options = {}) const
  {
    const std::string path = folder_.file ("cloud.pcd");
    pcl::io::savePCDFileBinary (path, cloud);
    return readPcdView (path, options);
  }

private:
  pcl::cosection::test::TemporaryFolder folder_;
};

/** \brief A plate of columns x rows points in front of the sensor, not quite on a grid. Beside every fourth row, some
 * points lie along a ray that just misses the right edge. */
pcl::PointCloud<pcl::PointXYZ>
plateWithTrail (int columns, int rows, int layers)
{
  constexpr float step = 0.005f, depth = 0.8f;
  std::mt19937 random (4);
  std::uniform_real_distribution<float> shift (-0.3f * step, 0.3f * step);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int v = 0; v < rows; ++v)
  {
    for (int u = 0; u < columns; ++u)
      cloud.emplace_back (step * static_cast<float> (u) + shift (random),
                          step * static_cast<float> (v) + shift (random), depth);
    for (int k = 0; k < layers && v % 4 == 0; ++k)
    {
      const float z = depth + 0.06f + 0.03f * static_cast<float> (k);
      cloud.emplace_back ((static_cast<float> (columns) - 0.5f) * step * z / depth,
                          step * static_cast<float> (v) * z / depth, z);
    }
  }
  return cloud;
}

pcl::PointCloud<pcl::PointNormal>
facingTheSensor (const pcl::PointCloud<pcl::PointXYZ>& bare)
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  for (const auto& p : bare)
    cloud.emplace_back (p.x, p.y, p.z, 0.0f, 0.0f, -1.0f);
  return cloud;
}

} // namespace

TEST_F (Trails, BehindEdgesAreLeftOut)
{
  for (const int layers :
       {8, 20}) // with 20, so many points are hidden from the sensor that this place would be refused
  {
    SCOPED_TRACE (layers);
    const pcl::PointCloud<pcl::PointXYZ> cloud = plateWithTrail (41, 41, layers);
    for (const LabelledView& view : {read (cloud), read (facingTheSensor (cloud))})
    {
      ASSERT_TRUE (view.view);
      EXPECT_TRUE (view.warnings.empty ()) << view.warnings[0];
      const auto& object = view.objects.at (1);
      EXPECT_EQ (object.readings, cloud.size ());
      const auto of_plate = std::count_if (object.points.begin (), object.points.end (),
                                           [] (const OrientedPoint& p) { return p.position.z () < 0.801f; });
      EXPECT_GT (of_plate, 41 * 41 * 97 / 100);
      EXPECT_EQ (object.points.size (), static_cast<std::size_t> (of_plate));
    }
  }
}

TEST_F (Trails, WhatWouldLeaveTooLittleIsKept)
{
  const pcl::PointCloud<pcl::PointXYZ> cloud = plateWithTrail (11, 9, 3);
  const LabelledView view = read (facingTheSensor (cloud));
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.objects.at (1).points.size (), cloud.size ());
}

/** \brief A thinned surface seen 5 degrees from its plane, such as the top of a box: each row of points lies far behind
 * the one before, and just beside it in the image. */
TEST_F (Trails, ASurfaceSeenAtAGrazingAngleIsNone)
{
  pcl::PointCloud<pcl::PointXYZ> cloud = plateWithTrail (121, 121, 0); // its front
  for (const auto& p : plateWithTrail (41, 41, 0))
    cloud.emplace_back (p.x, -0.09f * p.y - 0.003f, 0.8f + p.y);
  const LabelledView view = read (facingTheSensor (cloud));
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.objects.at (1).points.size (), cloud.size ());
}

/** \brief Images with one point per pixel have few mixed pixels, and a step is a surface. */
TEST_F (Trails, ImagesHaveNone)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int v = 0; v < 40; ++v)
    for (int u = 0; u < 40; ++u)
    {
      const float z = u == 37 ? 1.1f : 0.8f; // a row of pixels behind the others
      cloud.emplace_back (0.005f * static_cast<float> (u) * z, 0.005f * static_cast<float> (v) * z, z);
    }
  const LabelledView view = read (facingTheSensor (cloud));
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.objects.at (1).points.size (), cloud.size ());
}

/** \brief Absurd coordinates, as in damaged files, at which single precision determines no neighbourhood. */
TEST_F (Trails, AbsurdPointsAndPlacesHarmNothing)
{
  std::mt19937 random (5);
  std::uniform_real_distribution<float> exponent (-30.0f, 37.0f), unit (-1.0f, 1.0f);
  const auto absurd = [&] { return unit (random) * std::pow (10.0f, exponent (random)); };
  for (int n = 0; n < 60; ++n)
  {
    pcl::PointCloud<pcl::PointXYZ> cloud = plateWithTrail (20, 10, 1);
    for (int k = 0; k < 150 * (n % 3); ++k)
      cloud.emplace_back (absurd (), absurd (), n % 2 == 0 ? std::abs (absurd ()) : absurd ());
    cloud.sensor_origin_ << 0.1f, -0.2f, n % 5 == 0 ? 2147483647.0f : 0.1f, 1.0f;
    PcdViewOptions options;
    options.world_points = n % 7 < 3;
    EXPECT_GE (read (cloud, options).objects.at (1).readings, 100u);
  }
}
