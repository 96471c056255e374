// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The number of views that the back end keeps is bounded, and its result is that of the views that it keeps.

#include "backend_fixture.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST_F (BackendTest, AResultIsThatOfItsViews)
{
  CoSectionBackend backend (options ());
  EXPECT_TRUE (backend.addKeyframe (keyframe (0.0), atRest ()));
  EXPECT_TRUE (backend.addFrame (keyframe (0.1).view, atRest ()));
  EXPECT_TRUE (backend.addKeyframe (keyframe (-0.2), atRest ()));
  EXPECT_EQ (backend.views (), 3u);
  EXPECT_EQ (backend.keyframes (), 2u);
  const SceneResult result = backend.solve ();
  ASSERT_EQ (result.objects.size (), 1u);
  EXPECT_EQ (result.objects[0].id, ball);
  EXPECT_TRUE (computeTopology (result.objects[0].mesh).closed_manifold);
  EXPECT_FALSE (result.background.empty ());
  double sum = 0.0;
  for (const Eigen::Vector3f& vertex : result.objects[0].mesh.vertices)
    sum += std::abs ((vertex.cast<double> () - middle).norm () - 0.05);
  EXPECT_LT (sum / static_cast<double> (result.objects[0].mesh.vertices.size ()), 0.006) << "a voxel";
}

/** \brief They only say where the voxels are, if they are not forgotten. */
TEST_F (BackendTest, UpdatesDoNotChangeTheLastSolution)
{
  CoSectionBackend followed (options ()), plain (options ());
  for (const double x : {0.0, 0.1, -0.1})
  {
    followed.addKeyframe (keyframe (x), atRest ());
    plain.addKeyframe (keyframe (x), atRest ());
    EXPECT_EQ (followed.update (UpdateOutput::Fields).objects.at (0).error, "");
  }
  const MassProperties a = computeMassProperties (followed.solve ().objects.at (0).mesh);
  const MassProperties b = computeMassProperties (plain.solve ().objects.at (0).mesh);
  EXPECT_NEAR (a.volume_m3, b.volume_m3, 0.05 * b.volume_m3);
  EXPECT_LT ((a.centroid_m - b.centroid_m).norm (), 0.5 * options ().method.voxel_size_m);
  followed.forgetUpdates ();
  expectSame (followed.solve (), plain.solve ());
}

/** \brief The points of an object in its own frame, whatever its poses were. */
TEST_F (BackendTest, AMovedObjectIsInItsFrame)
{
  Eigen::Isometry3d T_world_ball = Eigen::Isometry3d::Identity ();
  T_world_ball.translate (middle);
  CoSectionBackend backend (options ());
  backend.addKeyframe (keyframe (0.0), {{ball, T_world_ball}});
  const SceneResult result = backend.solve ();
  ASSERT_EQ (result.objects.size (), 1u);
  ASSERT_EQ (result.objects[0].error, "");
  EXPECT_LT (computeMassProperties (result.objects[0].mesh).centroid_m.norm (), 0.02);
}

/** \brief A thing that the front end took for background until it moved away. */
TEST_F (BackendTest, WhatMovedAwayIsNoBackground)
{
  for (const bool leave_out : {false, true})
  {
    BackendOptions options = BackendTest::options ();
    options.method.leave_out_moved = leave_out;
    CoSectionBackend backend (options);
    const AnalyticScene with_ball = scene_;
    for (const double x : {0.0, 0.1})
    {
      Keyframe before = keyframe (x);
      std::vector<OrientedPoint>& background = before.points[0];
      background.insert (background.end (), before.points[ball].begin (), before.points[ball].end ());
      before.points.erase (ball);
      backend.addKeyframe (before, {});
    }
    scene_ = AnalyticScene ();
    scene_.add (0, halfSpace (Eigen::Vector4d::UnitZ ()));
    for (const double x : {-0.1, -0.05, 0.05})
      backend.addKeyframe (keyframe (x), {});
    scene_ = with_ball;
    float highest = 0.0f;
    for (const Eigen::Vector3f& vertex : backend.solve ().background.vertices)
      highest = std::max (highest, vertex.z ());
    EXPECT_EQ (highest < 0.01f, leave_out) << highest;
  }
}

/** \brief A thing that was background until it began to move, but stays nearby: no view looks through it. */
TEST_F (BackendTest, WhatTurnsOutToBeAnObjectIsNoBackground)
{
  for (const bool leave_out : {false, true})
    for (const float shift : {0.0f, 0.01f}) // of the object, before it is known
    {
      BackendOptions options = BackendTest::options ();
      options.method.leave_out_moved = leave_out;
      CoSectionBackend backend (options);
      Keyframe before = keyframe (0.0);
      std::vector<OrientedPoint>& background = before.points[0];
      for (OrientedPoint point : before.points[ball])
      {
        point.position.x () += shift;
        background.push_back (point);
      }
      before.points.erase (ball);
      backend.addKeyframe (before, {});
      for (const double x : {-0.1, 0.1})
        backend.addKeyframe (keyframe (x), atRest ());
      const SceneResult result = backend.solve ();
      float highest = 0.0f;
      for (const Eigen::Vector3f& vertex : result.background.vertices)
        highest = std::max (highest, vertex.z ());
      EXPECT_EQ (highest < 0.01f, leave_out) << highest << ", " << shift;
      EXPECT_EQ (result.objects.at (0).error, "");
    }
}

/** \brief Sides that only an earlier view saw. */
TEST_F (BackendTest, WhatIsBehindAnObjectThatWasNotYetKnownIsNoBackground)
{
  BackendOptions options = BackendTest::options ();
  options.method.leave_out_moved = true;
  CoSectionBackend backend (options);
  Keyframe before = keyframe (0.0);
  std::vector<OrientedPoint>& background = before.points[0];
  const Eigen::Isometry3f T_sensor_world = before.view.T_world_sensor.inverse ().cast<float> ();
  for (const OrientedPoint& point : before.points[ball])
    background.push_back (
        {2.0f * (T_sensor_world * middle.cast<float> ()) - point.position, -point.normal}); // through the middle
  before.points.erase (ball);
  backend.addKeyframe (before, {});
  for (const double x : {-0.1, 0.1})
    backend.addKeyframe (keyframe (x), atRest ());
  const SceneResult result = backend.solve ();
  for (const Eigen::Vector3f& vertex : result.background.vertices)
    ASSERT_LT (vertex.z (), 0.01f);
  const double ball_m3 = 4.0 / 3.0 * M_PI * std::pow (0.05, 3);
  EXPECT_NEAR (computeMassProperties (result.objects.at (0).mesh).volume_m3, ball_m3, 0.15 * ball_m3);
}

TEST_F (BackendTest, PointsWithoutPoseAreLeftOut)
{
  CoSectionBackend backend (options ());
  backend.addKeyframe (keyframe (0.0), {});
  EXPECT_TRUE (backend.solve ().objects.empty ());
}

TEST_F (BackendTest, TheNearestAreGivenUp)
{
  // The views are at 0, 1, 20 and 50 cm: that at 1 is removed, then that at 20, which is as near to 0 and later.
  CoSectionBackend backend (options (100, 4));
  for (const double x : {0.0, 0.01, 0.2, 0.5})
    EXPECT_TRUE (backend.addKeyframe (keyframe (x), atRest ()));
  EXPECT_TRUE (backend.addKeyframe (keyframe (-0.4), atRest ()));
  EXPECT_EQ (backend.keyframes (), 3u);
  CoSectionBackend fresh (options ());
  for (const double x : {0.0, 0.5, -0.4})
    fresh.addKeyframe (keyframe (x), atRest ());
  expectSame (backend.solve (), fresh.solve ());
  EXPECT_EQ (backend.update (UpdateOutput::Fields).objects.at (0).error, "");
}

TEST_F (BackendTest, AfterThinningNothingNearIsTaken)
{
  CoSectionBackend backend (options (100, 4));
  for (const double x : {0.0, 0.01, 0.2, 0.5, -0.4})
    backend.addKeyframe (keyframe (x), atRest ());
  ASSERT_EQ (backend.keyframes (), 3u);
  EXPECT_FALSE (backend.addKeyframe (keyframe (0.0), atRest ()));
  EXPECT_FALSE (backend.addKeyframe (keyframe (0.31), atRest ()))
      << "0.19 from that at 0.5, less than what was given up";
  EXPECT_FALSE (backend.addFrame (keyframe (-0.4).view, atRest ()));
  EXPECT_TRUE (backend.addKeyframe (keyframe (0.25), atRest ()));
  EXPECT_EQ (backend.views (), 4u);
  // The sensor stands where it has been, but the object has moved.
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity ();
  moved.translate (Eigen::Vector3d (0.3, 0.0, 0.0));
  EXPECT_TRUE (backend.addFrame (keyframe (0.0).view, {{ball, moved}}));
}

TEST_F (BackendTest, ThousandsOfFramesOfOnePlaceAreBounded)
{
  CoSectionBackend backend (options (12, 5));
  const Keyframe here = keyframe (0.0);
  std::size_t taken = 0;
  for (int n = 0; n < 2000; ++n)
  {
    taken += n % 10 == 0 ? backend.addKeyframe (here, atRest ()) : backend.addFrame (here.view, atRest ());
    ASSERT_LE (backend.views (), 12u);
    ASSERT_LE (backend.keyframes (), 5u);
  }
  EXPECT_GE (backend.keyframes (), 1u);
  EXPECT_LT (taken, 30u) << "what is there already is taken again and again";
  EXPECT_EQ (backend.solve ().objects.at (0).error, "");
}

TEST_F (BackendTest, ALongWayIsBoundedAndCovered)
{
  CoSectionBackend backend (options (12, 5));
  Keyframe moving = keyframe (0.0);
  moving.points.clear ();
  for (int n = 0; n < 500; ++n)
  {
    moving.view.T_world_sensor.translation ().x () = 0.01 * n;
    if (n % 10 == 0)
      backend.addKeyframe (moving, {});
    else
      backend.addFrame (moving.view, {});
    ASSERT_LE (backend.views (), 12u);
    ASSERT_LE (backend.keyframes (), 5u);
  }
  EXPECT_GE (backend.keyframes (), 2u);
}

TEST_F (BackendTest, WrongInputIsRefusedAndNotKept)
{
  BackendOptions few = options ();
  few.max_views = 3;
  EXPECT_THROW (CoSectionBackend backend (few), InvalidArgument);
  few = options ();
  few.max_keyframes = 1;
  EXPECT_THROW (CoSectionBackend backend (few), InvalidArgument);

  CoSectionBackend backend (options ());
  Keyframe wrong = keyframe (0.0);
  wrong.view.depth.pop_back ();
  EXPECT_THROW (backend.addKeyframe (wrong, {}), InvalidArgument);
  EXPECT_THROW (backend.addFrame (wrong.view, {}), InvalidArgument);
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity ();
  nowhere.translation ().x () = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (backend.addKeyframe (keyframe (0.0), {{ball, nowhere}}), InvalidArgument);
  EXPECT_THROW (backend.addFrame (keyframe (0.0).view, {{ball, nowhere}}), InvalidArgument);
  Keyframe negative = keyframe (0.0);
  negative.points[-1] = negative.points[ball];
  EXPECT_THROW (backend.addKeyframe (negative, {{-1, Eigen::Isometry3d::Identity ()}}), InvalidArgument);
  EXPECT_EQ (backend.views (), 0u);
}

TEST_F (BackendTest, CanBeCancelled)
{
  CoSectionBackend backend (options ());
  backend.addKeyframe (keyframe (0.0), atRest ());
  const auto no = [] (const std::string&, double) { return false; };
  EXPECT_THROW (backend.update (UpdateOutput::Meshes, no), Cancelled);
  EXPECT_THROW (backend.solve (no), Cancelled);
  EXPECT_EQ (backend.solve ().objects.at (0).error, "");
}
