// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Organised views whose points are in another frame than their sensor's.

#include "common/not_a_number.h"
#include "io/pcd_view_fixture.h"

#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cmath>
#include <utility>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

using ViewFrames = PcdView;

TEST_F (ViewFrames, WorldPointsMoveToTheSensor)
{
  auto cloud = organizedPlane ();
  pcl::io::savePCDFileBinary (path ("sensor.pcd"), cloud);
  const Eigen::Isometry3f T = Eigen::Translation3f (0.3f, -2.0f, 1.0f) *
                              Eigen::AngleAxisf (2.0f, Eigen::Vector3f (1, 2, 3).normalized ());
  moveBy (T, cloud);
  cloud.sensor_origin_.head<3> () = T.translation ();
  cloud.sensor_orientation_ = Eigen::Quaternionf (T.linear ());
  pcl::io::savePCDFileBinary (path ("world.pcd"), cloud);
  PcdViewOptions options;
  options.world_points = true;
  const LabelledView view = readPcdView (path ("world.pcd"), options);
  ASSERT_TRUE (view.view);
  EXPECT_NEAR (view.view->camera.fx, 60.0, 0.01);
  EXPECT_NEAR (view.view->at (3, 3), 1.0f, 1e-4f);
  const OrientedPoint& p = view.objects.at (7).points.front ();
  const OrientedPoint q = readPcdView (path ("sensor.pcd")).objects.at (7).points.front ();
  EXPECT_LT ((p.position - T * q.position).norm (), 1e-4f);
  EXPECT_LT ((p.normal - T.linear () * q.normal).norm (), 1e-3f);
}

/** \brief Clouds after pcl::transformPointCloud, which keeps the order of the points and does not change VIEWPOINT. */
TEST_F (ViewFrames, SensorIsFoundInAnyFrame)
{
  auto cloud = organizedStep ();
  cloud.at (5, 6).getVector3fMap ().setConstant (not_a_number);
  pcl::io::savePCDFileBinary (path ("sensor.pcd"), cloud);
  const LabelledView expected = readPcdView (path ("sensor.pcd"));
  const Eigen::Isometry3f T = Eigen::Translation3f (0.3f, -2.0f, 1.0f) *
                              Eigen::AngleAxisf (2.0f, Eigen::Vector3f (1, 2, 3).normalized ());
  moveBy (T, cloud);
  pcl::io::savePCDFileBinary (path ("no_viewpoint.pcd"), cloud);
  cloud.sensor_origin_.head<3> () = T.translation (); // as pcl::NormalEstimation wants it
  pcl::io::savePCDFileBinary (path ("viewpoint.pcd"), cloud);
  const std::pair<std::string, std::string> files[] = {{"no_viewpoint.pcd", "their pixels tell"},
                                                       {"viewpoint.pcd", "--world-points"}};
  for (const auto& [file, said] : files)
  {
    SCOPED_TRACE (file);
    const LabelledView view = readPcdView (path (file));
    ASSERT_EQ (view.warnings.size (), 1u);
    EXPECT_NE (view.warnings[0].find (said), std::string::npos) << view.warnings[0];
    ASSERT_TRUE (view.view);
    EXPECT_NEAR (view.view->camera.fx, 60.0, 0.05);
    EXPECT_NEAR (view.view->at (3, 3), 1.2f, 1e-3f);
    EXPECT_LT ((view.view->T_world_sensor.matrix () - T.matrix ().cast<double> ()).norm (), 2e-3);
    ASSERT_NEAR (static_cast<double> (view.objects.at (7).points.size ()),
                 static_cast<double> (expected.objects.at (7).points.size ()), 20.0);
    const OrientedPoint& p = view.objects.at (7).points.front ();
    const OrientedPoint& q = expected.objects.at (7).points.front ();
    EXPECT_LT ((p.position - T * q.position).norm (), 1e-4f);
    EXPECT_LT ((p.normal - T.linear () * q.normal).norm (), 5e-3f);
  }
}

/** \brief Points in the frame of the sensor's body, x forward and z up: the VIEWPOINT is correct, whatever its
 * rotation. */
TEST_F (ViewFrames, AxesOfABodyAreNotAnotherPlace)
{
  auto cloud = organizedStep ();
  for (auto& p : cloud)
    p.getVector3fMap () = Eigen::Vector3f (p.z, -p.x, -p.y);
  for (const Eigen::Vector3f& place :
       {Eigen::Vector3f (0.0f, 0.0f, 0.0f), Eigen::Vector3f (0.01f, 0.0f, 0.02f), Eigen::Vector3f (1.0f, 2.0f, 0.5f)})
  {
    const Eigen::Isometry3f T = Eigen::Translation3f (place) * Eigen::AngleAxisf (1.5f, Eigen::Vector3f::UnitZ ());
    cloud.sensor_origin_.head<3> () = place;
    cloud.sensor_orientation_ = Eigen::Quaternionf (T.linear ());
    pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
    const LabelledView view = readPcdView (path ("a.pcd"));
    ASSERT_TRUE (view.view);
    EXPECT_LT ((view.view->T_world_sensor.translation () - place.cast<double> ()).norm (), 1e-3);
    EXPECT_LT ((view.view->T_world_sensor.linear ().col (2).cast<float> () - T.linear ().col (0)).norm (), 1e-3f);
    const Eigen::Vector3f p = cloud.at (40, 10).getVector3fMap ();
    bool found = false;
    for (const OrientedPoint& q : view.objects.at (7).points)
      found = found || (q.position - T * p).norm () < 1e-3f;
    EXPECT_TRUE (found);
  }
}

/** \brief Zeros are missing readings also in another frame than the sensor's. */
TEST_F (ViewFrames, ZerosOfTheFileAreNoReadings)
{
  auto cloud = organizedPlane ();
  moveBy (Eigen::Isometry3f (Eigen::Translation3f (0.3f, -0.2f, 1.0f)), cloud);
  for (std::size_t i = 0; i < cloud.size (); i += 3)
    cloud[i].getVector3fMap ().setZero ();
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  PcdViewOptions options;
  options.viewpoint = {0.3, -0.2, 1.0};
  const LabelledView view = readPcdView (path ("a.pcd"), options);
  EXPECT_TRUE (view.view);
  EXPECT_TRUE (view.warnings.empty ());
  EXPECT_EQ (view.objects.at (0).readings + view.objects.at (7).readings, 64u * 48u * 2u / 3u);
}

/** \brief As of a profile scanner: no point is seen from the origin as by a camera, or by a lidar that turns. */
TEST_F (ViewFrames, ParallelRaysAreNoCameras)
{
  pcl::PointCloud<pcl::PointXYZL> cloud (100, 80);
  for (int v = 0; v < 80; ++v)
    for (int u = 0; u < 100; ++u)
    {
      const Eigen::Vector2f at = 0.004f *
                                 Eigen::Vector2f (static_cast<float> (u) - 50.0f, static_cast<float> (v) - 40.0f);
      const float height = std::sqrt (std::max (0.0f, 0.01f - at.squaredNorm ())); // half a ball on a table
      cloud.at (u, v).getVector3fMap () = Eigen::Vector3f (at.x (), at.y (), 0.7f - height);
      cloud.at (u, v).label = height > 0.0f ? 1 : 0;
    }
  pcl::io::savePCDFileBinary (path ("scan.pcd"), cloud);
  const LabelledView view = readPcdView (path ("scan.pcd"));
  EXPECT_EQ (std::count_if (view.warnings.begin (), view.warnings.end (),
                            [] (const std::string& warning) {
                              return warning.find ("its rays are parallel") != std::string::npos;
                            }),
             1);
  for (const OrientedPoint& point : view.objects.at (1).points)
    ASSERT_GT (point.normal.dot (point.position - Eigen::Vector3f (0.0f, 0.0f, 0.7f)), 0.0f);
}
