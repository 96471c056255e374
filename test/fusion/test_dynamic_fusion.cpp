// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The front end on simulated scenes, against their exact truth.

#include "tracked_scene.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Masks of every n-th frame. */
MaskPolicy
every (int n)
{
  return [n] (int frame, const Image<std::uint16_t>& truth) -> std::optional<Image<std::uint16_t>> {
    return frame % n == 0 ? std::optional (reshuffled (truth, frame)) : std::nullopt;
  };
}

} // namespace

TEST (DynamicFusion, AMovingObjectBeforeAStaticCamera)
{
  TrackedScene scene (30);
  scene.addThing (1, movingThing ({-0.2, 0.0, 0.0}, {0.2, 0.1, 0.0}, 0.8));
  const TrackedRun run = scene.run (every (10));
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_LT (run.cameraError (), camera_limit_m);
  ASSERT_EQ (run.framesOf (1), 30);
  EXPECT_LT (run.objectError (1, scene.body (1)), object_limit_m);
}

TEST (DynamicFusion, AMovingCameraInAStaticScene)
{
  TrackedScene scene (30);
  scene.moveCamera ({-0.15, -1.3, 0.9}, {0.15, -1.2, 1.0});
  const TrackedRun run = scene.run (noMask);
  EXPECT_TRUE (run.found.empty ());
  EXPECT_EQ (run.framesWithCamera (), 30);
  EXPECT_LT (run.cameraError (), camera_limit_m);
  EXPECT_TRUE (run.events.empty ()) << run.events.front ();
}

TEST (DynamicFusion, EverythingMovesAndTheFirstMaskIsTheOnlyOne)
{
  TrackedScene scene (24);
  scene.moveCamera ({-0.1, -1.3, 0.9}, {0.1, -1.25, 0.95});
  scene.addThing (1, movingThing ({-0.3, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.5));
  scene.addThing (2, movingThing ({0.3, 0.1, 0.0}, {0.3, 0.1, 0.0}, 0.0));
  const TrackedRun run = scene.run (every (1000));
  EXPECT_EQ (run.found.size (), 2u);
  EXPECT_LT (run.cameraError (), camera_limit_m);
  for (const int id : {1, 2})
  {
    const int found = run.foundAs (id);
    ASSERT_EQ (run.framesOf (found), 24) << id;
    EXPECT_LT (run.objectError (found, scene.body (id)), object_limit_m) << id;
  }
}

TEST (DynamicFusion, AnObjectThatLeavesIsNoPartOfTheBackground)
{
  TrackedScene scene (36);
  scene.addThing (1, movingThing ({0.0, 0.1, 0.0}, {1.6, 0.1, 0.0}, 0.0));
  const TrackedRun run = scene.run (every (6));
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_LT (run.cameraError (), camera_limit_m);
  EXPECT_LT (run.framesOf (1), 36);
  EXPECT_EQ (run.frames.back ().T_world_object.count (1), 0u);
  EXPECT_LT (run.objectError (1, scene.body (1)), object_limit_m);
  EXPECT_LT (run.shareOfBackgroundInside (scene, 1, 0.03), 1e-3);
}

TEST (DynamicFusion, FramesWithoutDepthAreLeftOut)
{
  TrackedScene scene (24);
  scene.addThing (1, movingThing ({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 0.3));
  scene.spoil ([] (int frame, Image<float>& depth) {
    for (std::size_t n = 0; n < depth.pixels.size (); ++n)
      if (frame == 9 || frame == 10 || (frame * 31 + n * 7919) % 10 < 3)
        depth.pixels[n] = std::numeric_limits<float>::quiet_NaN ();
  });
  const TrackedRun run = scene.run (every (8));
  EXPECT_EQ (run.framesWithCamera (), 22);
  EXPECT_FALSE (run.frames[9].T_world_camera);
  EXPECT_TRUE (run.frames[9].instances.pixels.empty ());
  EXPECT_LT (run.cameraError (), 0.010); // a third of the readings are missing in all frames
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_GE (run.framesOf (1), 21);
  EXPECT_LT (run.objectError (1, scene.body (1)), object_limit_m);
}

TEST (DynamicFusion, TheCameraDoesNotSlideAlongABareWall)
{
  TrackedScene scene (20, TrackedScene::Surroundings::Wall);
  const TrackedRun run = scene.run (noMask);
  EXPECT_EQ (run.framesWithCamera (), 20);
  EXPECT_LT (run.cameraError (), 0.002);
}

TEST (DynamicFusion, AnObjectThatNoMaskShowsAgainIsGivenUp)
{
  TrackedScene scene (24);
  scene.addThing (1, movingThing ({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0));
  const TrackedRun run = scene.run ([] (int frame, const Image<std::uint16_t>& truth) {
    return std::optional (frame == 0 ? truth : Image<std::uint16_t> (truth.width, truth.height));
  });
  EXPECT_TRUE (run.found.empty ());
  ASSERT_FALSE (run.events.empty ());
  EXPECT_NE (run.events.back ().find ("object 1 is given up: it was in 1 of "), std::string::npos)
      << run.events.back ();
}

TEST (DynamicFusion, SmallInstancesBeginNoObject)
{
  TrackedScene scene (2);
  scene.addThing (1, movingThing ({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0));
  DynamicFusionOptions options;
  options.min_object_pixels = 100000;
  const TrackedRun run = scene.run (every (10), options);
  EXPECT_TRUE (run.found.empty ());
  ASSERT_EQ (run.events.size (), 1u);
  EXPECT_NE (run.events[0].find ("began no object: it has "), std::string::npos) << run.events[0];
  ASSERT_EQ (run.refused.size (), 1u);
  EXPECT_NE (run.refused.begin ()->second.find (" are needed"), std::string::npos);
}

TEST (DynamicFusion, InstancesThatShowAnObjectInALaterMaskAreNotRefused)
{
  TrackedScene scene (12);
  scene.addThing (1, movingThing ({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0));
  const auto cut = [] (int frame, const Image<std::uint16_t>& truth) { // a strip of it in the first mask
    Image<std::uint16_t> mask = truth;
    int left = 40;
    for (std::uint16_t& pixel : mask.pixels)
      if (frame == 0 && pixel == 1 && left-- <= 0)
        pixel = 0;
    return frame % 10 == 0 ? std::optional (mask) : std::nullopt;
  };
  const TrackedRun run = scene.run (cut);
  EXPECT_FALSE (run.found.empty ());
  EXPECT_TRUE (run.refused.empty ());
  EXPECT_TRUE (run.said ("began no object: it has "));
}

TEST (DynamicFusion, ResultsDoNotDependOnThreads)
{
  TrackedScene scene (6);
  scene.addThing (1, movingThing ({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 0.3));
  DynamicFusionOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const TrackedRun a = scene.run (every (3), one);
  const TrackedRun b = scene.run (every (3), two);
  for (std::size_t n = 0; n < a.frames.size (); ++n)
  {
    ASSERT_TRUE (a.frames[n].T_world_camera && b.frames[n].T_world_camera);
    EXPECT_EQ (a.frames[n].T_world_camera->matrix (), b.frames[n].T_world_camera->matrix ());
    ASSERT_EQ (a.frames[n].T_world_object.size (), b.frames[n].T_world_object.size ());
    for (const auto& [id, T] : a.frames[n].T_world_object)
      EXPECT_EQ (T.matrix (), b.frames[n].T_world_object.at (id).matrix ());
    EXPECT_EQ (a.frames[n].instances.pixels, b.frames[n].instances.pixels);
  }
}

TEST (DynamicFusion, WhatCannotBeUsedIsRefused)
{
  const PinholeCamera camera{40, 30, 45.0, 45.0, 19.5, 14.5};
  DynamicFusionOptions options;
  options.object_resolution = 1;
  EXPECT_THROW ((DynamicFusion{camera, options}), InvalidArgument);
  EXPECT_THROW (DynamicFusion{PinholeCamera{}}, InvalidArgument);
  options = DynamicFusionOptions ();
  options.background_resolution = 32;
  DynamicFusion fusion (camera, options);
  RgbdFrame frame;
  frame.depth = Image<float> (20, 30, 1.0f);
  EXPECT_THROW (fusion.process (frame), InvalidArgument);
  frame.depth = Image<float> (40, 30, 1.0f);
  const Image<std::uint16_t> mask (4, 4);
  EXPECT_THROW (fusion.process (frame, &mask), InvalidArgument);
}
