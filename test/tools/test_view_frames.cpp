// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with views in another frame than their sensor's.

#include "any_cloud_fixture.h"

#include <algorithm>
#include <random>
#include <utility>

using ViewFrames = AnyCloud;

/** \brief In the frame of a robot's base, whatever of the sensor's place is known. */
TEST_F (ViewFrames, ViewsInTheWorldFrameAreAsGood)
{
  writeTableScene (path ("view.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> cloud, unordered;
  pcl::io::loadPCDFile (path ("view.pcd"), cloud);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity (); // the world's origin: on the floor below the table
  T.translate (Eigen::Vector3f (0.2f, 0.1f, 0.7f));
  T.translate (cloud.sensor_origin_.head<3> ());
  T.rotate (cloud.sensor_orientation_);
  const Eigen::Vector3f sensor = T.translation ();
  for (auto& p : cloud)
    p.getVector3fMap () = T * Eigen::Vector3f (p.getVector3fMap ());
  cloud.sensor_origin_.setZero ();
  cloud.sensor_orientation_.setIdentity ();
  pcl::io::savePCDFileBinary (path ("organized.pcd"), cloud);
  cloud.sensor_origin_.head<3> () = sensor;
  pcl::io::savePCDFileBinary (path ("told.pcd"), cloud);
  for (const auto& p : cloud)
    if (std::isfinite (p.x))
      unordered.push_back (p);
  pcl::io::savePCDFileBinary (path ("unorganized.pcd"), unordered);
  std::shuffle (unordered.begin (), unordered.end (), std::mt19937 (1));
  pcl::io::savePCDFileBinary (path ("shuffled.pcd"), unordered);
  unordered.sensor_origin_.head<3> () = sensor;
  pcl::io::savePCDFileBinary (path ("shuffled_told.pcd"), unordered);
  const std::string place = std::to_string (sensor.x ()) + "," + std::to_string (sensor.y ()) + "," +
                            std::to_string (sensor.z ());

  ASSERT_EQ (run ({"view.pcd", "expected"}), 0) << errors_;
  const std::pair<std::vector<std::string>, std::string> views[] = {
      {{"organized.pcd"}, "their pixels tell that it stood at"},
      {{"told.pcd"}, "taken as with --world-points"},
      {{"unorganized.pcd"}, "the order of its points tells"},
      {{"--viewpoint", place, "organized.pcd"}, ""},
      {{"--viewpoint", place, "shuffled.pcd"}, ""},
      {{"shuffled_told.pcd"}, "taken as with --world-points"}};
  for (const auto& [arguments, said] : views)
  {
    SCOPED_TRACE (arguments.back ());
    std::vector<std::string> all = arguments;
    all.emplace_back ("out");
    ASSERT_EQ (run (all), 0) << errors_;
    EXPECT_NE (errors_.find (said), std::string::npos) << errors_;
    if (said.empty ())
    {
      EXPECT_EQ (errors_, "");
    }
    for (const char* object : {"object_1.ply", "object_2.ply"})
      EXPECT_NEAR (volume (std::string ("out/") + object), volume (std::string ("expected/") + object),
                   0.1 * volume (std::string ("expected/") + object));
  }
}

/** \brief One file of two views was not seen from one place, near as these may be. */
TEST_F (ViewFrames, MergedViewsWithoutTheirOrderHaveNoViewpoint)
{
  writeTableScene (path ("view.pcd"));
  pcl::PointCloud<pcl::PointXYZRGBL> view, merged;
  pcl::io::loadPCDFile (path ("view.pcd"), view);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity ();
  T.translate (view.sensor_origin_.head<3> ());
  T.rotate (view.sensor_orientation_);
  for (const float turn : {0.0f, 1.2f}) // the same seen from elsewhere, about the vertical axis
    for (const auto& p : view)
      if (std::isfinite (p.x))
      {
        merged.push_back (p);
        merged.back ().getVector3fMap () = Eigen::AngleAxisf (turn, Eigen::Vector3f::UnitZ ()) *
                                           (T * Eigen::Vector3f (p.getVector3fMap ()));
      }
  std::shuffle (merged.begin (), merged.end (), std::mt19937 (1));
  pcl::io::savePCDFileBinary (path ("merged.pcd"), merged);
  EXPECT_EQ (run ({"merged.pcd", "out"}), 0);
  EXPECT_EQ (errors_.find ("the order of its points tells"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("where its points were seen from is not known"), std::string::npos) << errors_;
}

TEST_F (ViewFrames, ViewpointsThatAreNoneAreNamed)
{
  writeSphere (path ("ball.pcd"), 1000);
  const auto fails = [this] (std::vector<std::string> arguments, const std::string& part) {
    arguments.insert (arguments.end (), {"ball.pcd", "ball.pcd", "ball.pcd", "out.ply"});
    EXPECT_EQ (run (arguments), 2);
    EXPECT_NE (errors_.find (part), std::string::npos) << errors_;
  };
  fails ({"--viewpoint", "1,2"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,3,4"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,nan"}, "--viewpoint must be three numbers x,y,z");
  fails ({"--viewpoint", "1,2,3", "--viewpoint", "1,2,4"}, "--viewpoint is given 2 times for 3 views");
}
