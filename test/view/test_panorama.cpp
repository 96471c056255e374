// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Sensors that see all around.

#include "io/pcd_view_fixture.h"

#include <pcl/io/pcd_io.h>

#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int columns = 360, rows = 40;

/** \brief What a spinning lidar sees of a round room with a box in it: rows of one elevation, columns of one azimuth.
 * \param[in] radius_m of the room
 * \param[in] height_m of the sensor over the floor */
pcl::PointCloud<pcl::PointXYZL>
turnInARoom (float radius_m = 5.0f, float height_m = 5.0f)
{
  pcl::PointCloud<pcl::PointXYZL> cloud (columns, rows);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
    {
      const float azimuth = 2.0f * static_cast<float> (M_PI) * u / columns, elevation = 0.3f - 0.015f * v;
      const Eigen::Vector3f ray (std::cos (azimuth) * std::cos (elevation), std::sin (azimuth) * std::cos (elevation),
                                 std::sin (elevation));
      float range = radius_m / std::cos (elevation);
      if (ray.z () < 0.0f)
        range = std::min (range, -height_m / ray.z ());
      const float to_box = 2.0f / ray.x (); // its face at x = 2
      const Eigen::Vector3f at = to_box * ray;
      const bool on_box = to_box > 0.0f && std::abs (at.y ()) < 0.5f && std::abs (at.z ()) < 0.4f;
      range = on_box ? to_box : range;
      cloud (u, v).getVector3fMap () = range * ray;
      cloud (u, v).label = on_box ? 1 : 0;
    }
  return cloud;
}

} // namespace

using Panorama = PcdView;

TEST_F (Panorama, AnOrganisedTurnShowsFreeSpaceAllAround)
{
  pcl::io::savePCDFileBinary (path ("turn.pcd"), turnInARoom ());
  const LabelledView view = readPcdView (path ("turn.pcd"));
  EXPECT_EQ (view.warnings, std::vector<std::string> ());
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.other_views.size (), 3u); // there is nothing above or below
  for (const OrientedPoint& point : view.objects.at (1).points)
    EXPECT_LT (point.normal.x (), -0.9f); // towards the sensor
  std::size_t readings = 0;
  for (const float depth : view.view->depth)
    readings += std::isfinite (depth);
  EXPECT_GT (readings, 1000u);
}

TEST_F (Panorama, OutlinesAreHalfWayBetweenReadings)
{
  pcl::io::savePCDFileBinary (path ("turn.pcd"), turnInARoom ());
  const LabelledView view = readPcdView (path ("turn.pcd"));
  ASSERT_TRUE (view.view);
  const double step_m = 2.0 * 2.0 * M_PI / columns; // between readings on the box
  Eigen::AlignedBox3d box;
  int pixels = 0;
  std::vector<DepthView> images = view.other_views;
  images.push_back (*view.view);
  for (const DepthView& image : images)
    for (int v = 0; v < image.camera.height; ++v)
      for (int u = 0; u < image.camera.width; ++u)
        if (const Eigen::Vector3d p = image.T_world_sensor * image.camera.unproject (u, v, image.at (u, v));
            std::abs (p.x () - 2.0) < 0.1 && p.norm () < 3.0) // the wall is at 5
        {
          box.extend (p);
          ++pixels;
        }
  EXPECT_GT (pixels, 700); // of 760 readings
  EXPECT_NEAR (box.min ().y (), -0.5, step_m);
  EXPECT_NEAR (box.max ().y (), 0.5, step_m);
  EXPECT_NEAR (box.min ().z (), -0.4, step_m);
  EXPECT_GT (box.max ().z (), 0.4 - step_m);
}

/** \brief A width that is not that of the sensor: steps along rows and columns are as steady, but beside each other. */
TEST_F (Panorama, RowsOfAnotherWidthAreNotTheSensors)
{
  pcl::PointCloud<pcl::PointXYZL> cloud = turnInARoom ();
  cloud.width = 300;
  cloud.height = 48;
  pcl::io::savePCDFileBinary (path ("turn.pcd"), cloud);
  const LabelledView view = readPcdView (path ("turn.pcd"));
  EXPECT_TRUE (view.other_views.empty ());
  ASSERT_FALSE (view.warnings.empty ());
  EXPECT_NE (view.warnings.front ().find ("not the image of a pinhole camera"), std::string::npos);
}

TEST_F (Panorama, GroundSeenNearlyLevelIsNotHidden)
{
  pcl::io::savePCDFileBinary (path ("turn.pcd"), turnInARoom (45.0f, 1.0f)); // its rings are up to 20 m apart
  const LabelledView view = readPcdView (path ("turn.pcd"));
  EXPECT_EQ (view.warnings, std::vector<std::string> ());
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.other_views.size (), 3u);
}

TEST_F (Panorama, ATurnInAnotherFrameShowsNoFreeSpaceFromItsOrigin)
{
  pcl::PointCloud<pcl::PointXYZL> cloud = turnInARoom (45.0f, 1.0f);
  for (pcl::PointXYZL& p : cloud)
    p.z += 1.0f; // as from the floor
  pcl::io::savePCDFileBinary (path ("turn.pcd"), cloud);
  const LabelledView view = readPcdView (path ("turn.pcd"));
  EXPECT_FALSE (view.view);
  EXPECT_FALSE (view.warnings.empty ());
}

TEST_F (Panorama, AViewpointThatIsGivenIsBelieved)
{
  pcl::PointCloud<pcl::PointXYZL> cloud = turnInARoom ();
  for (pcl::PointXYZL& p : cloud)
    p.x += 10.0f;
  cloud.width = columns * rows;
  cloud.height = 1;
  pcl::io::savePCDFileBinary (path ("turn.pcd"), cloud);
  PcdViewOptions options;
  options.viewpoint = {10.0, 0.0, 0.0};
  const LabelledView view = readPcdView (path ("turn.pcd"), options);
  EXPECT_EQ (view.warnings, std::vector<std::string> ());
  ASSERT_TRUE (view.view);
  EXPECT_EQ (view.other_views.size (), 3u);
  EXPECT_LT ((view.other_views[0].T_world_sensor.translation () - Eigen::Vector3d (10, 0, 0)).norm (), 1e-6);
  options.viewpoint = {14.0, 1.0, 0.0}; // behind the box
  EXPECT_FALSE (readPcdView (path ("turn.pcd"), options).view);
}
