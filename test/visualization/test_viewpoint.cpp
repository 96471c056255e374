// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "run_folder.h"

#include "common/message_of.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (Viewpoint, IsReadAsItWasWritten)
{
  const TemporaryFolder folder;
  Viewpoint view;
  view.eye = {1.25, -0.3, 1.0 / 3.0};
  view.target = {0.1, 0.2, 0.3};
  view.up = {0.0, 0.1, 1.0};
  view.angle_rad = 0.6;
  saveViewpoint (view, folder.file ("view.json"));
  const Viewpoint read = loadViewpoint (folder.file ("view.json"));
  EXPECT_TRUE (read.eye.isApprox (view.eye, 1e-12));
  EXPECT_TRUE (read.target.isApprox (view.target, 1e-12));
  EXPECT_TRUE (read.up.isApprox (view.up, 1e-12));
  EXPECT_NEAR (read.angle_rad, view.angle_rad, 1e-12);
}

TEST (Viewpoint, LooksAtItsTarget)
{
  Viewpoint view;
  view.eye = {2.0, 1.0, 1.5};
  view.target = {0.2, -0.1, 0.4};
  view.up = {0.0, 0.0, 1.0};
  const PinholeCamera camera = view.camera (640, 480);
  const Eigen::Isometry3d T_camera_world = view.pose ().inverse ();
  EXPECT_TRUE (camera.project (T_camera_world * view.target).isApprox (Eigen::Vector2d (319.5, 239.5), 1e-9));
  EXPECT_LT (camera.project (T_camera_world * (view.target + 0.1 * view.up)).y (), 239.5); // up is up
  EXPECT_NEAR (view.pose ().linear ().determinant (), 1.0, 1e-12);
  // From edge to edge it is angle_rad.
  const Eigen::Vector3d upper = camera.unproject (319.5, -0.5, 1.0), lower = camera.unproject (319.5, 479.5, 1.0);
  EXPECT_NEAR (std::acos (upper.normalized ().dot (lower.normalized ())), view.angle_rad, 1e-9);
}

TEST (Viewpoint, WrongFilesAreReported)
{
  const TemporaryFolder folder;
  const std::string path = folder.file ("view.json");
  const auto failure = [&path] { return messageOf<IoError> ([&path] { loadViewpoint (path); }); };
  EXPECT_NE (failure ().find ("cannot be read"), std::string::npos);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "JSON object"},
      {"[1]", "JSON object"},
      {R"({"eye": [0, 0], "target": [0, 0, 1], "up": [0, 1, 0], "angle_deg": 40})", "eye must be three numbers"},
      {R"({"eye": [0, 0, 0], "target": [0, 0, "a"], "up": [0, 1, 0], "angle_deg": 40})",
       "target must be three numbers"},
      {R"({"eye": [0, 0, 0], "target": [0, 0, 0], "up": [0, 1, 0], "angle_deg": 40})", "different places"},
      {R"({"eye": [0, 0, 0], "target": [0, 0, 1], "up": [0, 0, 2], "angle_deg": 40})", "up must be a direction"},
      {R"({"eye": [0, 0, 0], "target": [0, 0, 1], "up": [0, 1, 0]})", "angle_deg must be a number"},
      {R"({"eye": [0, 0, 0], "target": [0, 0, 1], "up": [0, 1, 0], "angle_deg": 180})", "between 0 and 180"}};
  for (const auto& [text, part] : cases)
  {
    writeFile (path, text);
    const std::string message = failure ();
    EXPECT_NE (message.find (part), std::string::npos) << message;
    EXPECT_EQ (message.rfind (path, 0), 0u) << message;
  }
  Viewpoint view;
  view.eye.x () = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (view.validate (), InvalidArgument);
}

TEST (Viewpoint, OverviewShowsAllObjectsAtAllTimes)
{
  RunScene scene = movingRun ();
  EXPECT_GT (upDirection (scene).z (), 0.5); // the cameras look down
  scene.run.background.normals.assign (scene.run.background.vertices.size (), Eigen::Vector3f::UnitZ ());
  EXPECT_TRUE (upDirection (scene).isApprox (Eigen::Vector3d::UnitZ (), 1e-6)); // there is a floor
  for (const double turn : {0.0, 1.0, M_PI})
  {
    const Viewpoint view = overview (scene, turn);
    const PinholeCamera camera = view.camera (1280, 720);
    const Eigen::Isometry3d T_camera_world = view.pose ().inverse ();
    EXPECT_GT ((view.eye - view.target).dot (upDirection (scene)), 0.0); // from above
    for (const SceneRecord::Object& object : scene.run.objects)
      for (const StampedPose& pose : object.poses)
        for (const Eigen::Vector3f& v : object.mesh.vertices)
        {
          const Eigen::Vector3d p = T_camera_world * pose.pose * v.cast<double> ();
          const Eigen::Vector2d pixel = camera.project (p);
          ASSERT_TRUE (p.z () > 0.0 && pixel.x () > 0.0 && pixel.x () < 1280.0 && pixel.y () > 0.0 &&
                       pixel.y () < 720.0)
              << turn;
        }
  }
}

TEST (Viewpoint, OverviewIsFoundForAnyScene)
{
  RunScene scene;
  scene.run.camera.push_back ({});
  EXPECT_NO_THROW (overview (scene).validate ());
  scene.run.background = planeMesh (1.0, 4);
  EXPECT_NO_THROW (overview (scene).validate ());
  // From right above.
  StampedPose above;
  above.pose.linear () << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  above.pose.translation () << 0.5, 0.5, 2.0;
  scene.run.camera = {above};
  scene.run.background.normals.assign (scene.run.background.vertices.size (), Eigen::Vector3f::UnitZ ());
  EXPECT_NO_THROW (overview (scene).validate ());
}

TEST (Viewpoint, FittedCameraSeesWhatTheOtherSees)
{
  const PinholeCamera camera = {640, 480, 525.0, 520.0, 300.0, 250.0};
  for (const auto& [width, height] : {std::pair{1280, 720}, {320, 240}, {400, 800}})
  {
    const PinholeCamera fitted = fittedCamera (camera, width, height);
    for (const auto& [u, v] : {std::pair{-0.5, -0.5}, {639.5, -0.5}, {639.5, 479.5}, {-0.5, 479.5}})
    {
      const Eigen::Vector2d pixel = fitted.project (camera.unproject (u, v, 1.0));
      EXPECT_GE (pixel.x (), -0.5 - 1e-9);
      EXPECT_LE (pixel.x (), width - 0.5 + 1e-9);
      EXPECT_GE (pixel.y (), -0.5 - 1e-9);
      EXPECT_LE (pixel.y (), height - 0.5 + 1e-9);
    }
    EXPECT_NEAR (fitted.fx / fitted.fy, camera.fx / camera.fy, 1e-12);
  }
  const PinholeCamera same = fittedCamera (camera, 640, 480);
  EXPECT_NEAR (same.cx, camera.cx, 1e-9);
  EXPECT_NEAR (same.cy, camera.cy, 1e-9);
}
