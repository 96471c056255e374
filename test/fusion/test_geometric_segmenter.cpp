// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Objects that are found by geometry while they are tracked, and what masks that are not exact do to them.

#include "tracked_scene.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

DynamicFusionOptions
everyFive ()
{
  DynamicFusionOptions options;
  options.segment_every = 5;
  return options;
}

/** \brief Of the pixels that show a body or are labelled as the object, the share that is both. */
double
imageIou (const TrackedRun& run, int frame, int body, int id)
{
  std::size_t both = 0, either = 0;
  for (std::size_t n = 0; n < run.masks[frame].pixels.size (); ++n)
  {
    const bool a = run.masks[frame].pixels[n] == body, b = run.frames[frame].instances.pixels[n] == id;
    both += a && b;
    either += a || b;
  }
  return static_cast<double> (both) / static_cast<double> (either);
}

} // namespace

TEST (GeometricSegmenter, AThingThatMovesIsFoundAndFollowed)
{
  TrackedScene scene (36);
  scene.moveCamera ({-0.1, -1.3, 0.9}, {0.1, -1.25, 0.95});
  scene.addThing (1, along ({0.0, 0.3, 1.0}, {{-0.2, 0.0, 0.0}, {-0.2, 0.0, 0.0}, {0.2, 0.1, 0.0}}));
  const TrackedRun run = scene.run (noMask, everyFive (), std::make_shared<GeometricSegmenter> ());
  EXPECT_LT (run.cameraError (), 0.006);
  const int id = run.foundAs (1);
  ASSERT_GT (id, 0);
  EXPECT_GE (run.framesOf (id), 30);
  EXPECT_LT (run.objectError (id, scene.body (1)), 0.02); // its first model is but a part of it
  for (int frame = 24; frame < 36; ++frame)
    EXPECT_GT (imageIou (run, frame, 1, id), 0.8) << frame;
}

TEST (GeometricSegmenter, WithoutAPlaneItSaysNothing)
{
  const PinholeCamera camera{80, 60, 90.0, 90.0, 39.5, 29.5};
  RgbdFrame images;
  images.depth = Image<float> (camera.width, camera.height);
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      images.depth.at (u, v) = 0.8f + 0.15f * std::sin (0.4f * static_cast<float> (u)) *
                                          std::sin (0.4f * static_cast<float> (v));
      points.push_back (camera.unproject (u, v, images.depth.at (u, v)).cast<float> ());
    }
  const Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity ();
  const Image<std::uint16_t> labels (camera.width, camera.height, 0);
  const Image<std::uint8_t> moving (camera.width, camera.height, 0);
  GeometricSegmenter segmenter;
  const FrameInstances found = segmenter.segment ({images, camera, points, T_world_camera, {}, labels, moving});
  EXPECT_FALSE (found.mask);
  EXPECT_NE (found.note.find ("no plane in view"), std::string::npos) << found.note;
  ObjectSegmentationOptions options;
  options.max_object_size_m = -1.0;
  EXPECT_THROW (GeometricSegmenter{options}, InvalidArgument);
}

TEST (GeometricSegmenter, ResultsDoNotDependOnThreads)
{
  TrackedScene scene (11);
  scene.addThing (1, movingThing ({-0.1, 0.0, 0.0}, {0.2, 0.0, 0.0}, 0.3));
  std::vector<TrackedRun> runs;
  for (const int threads : {1, 2})
  {
    DynamicFusionOptions options = everyFive ();
    options.threads = threads;
    ObjectSegmentationOptions segmentation;
    segmentation.threads = threads;
    runs.push_back (scene.run (noMask, options, std::make_shared<GeometricSegmenter> (segmentation)));
  }
  for (std::size_t n = 0; n < runs[0].frames.size (); ++n)
    EXPECT_EQ (runs[0].frames[n].instances.pixels, runs[1].frames[n].instances.pixels) << n;
}

TEST (UnreliableMasks, AnObjectThatFallsIntoPartsInOneMaskStaysOne)
{
  TrackedScene scene (24);
  scene.addThing (1, along ({0.0}, {{0.0, 0.0, 0.0}}));
  const TrackedRun run = scene.run (noMask, everyFive (),
                                    std::make_shared<FakeSegmenter> ([] (const Eigen::Vector3d& p, int frame) {
                                      return !isThing (p, 0.0) ? 0 : frame == 10 && p.x () > 0.0 ? 7 : 3;
                                    }));
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_GE (run.framesOf (1), 18);
  EXPECT_GT (imageIou (run, 12, 1, 1), 0.8);
}

TEST (UnreliableMasks, TwoObjectsThatAreOneInstanceOnceStayTwo)
{
  TrackedScene scene (24);
  scene.addThing (1, along ({0.0}, {{-0.15, 0.0, 0.0}}));
  scene.addThing (2, along ({0.0}, {{0.15, 0.0, 0.0}}));
  const TrackedRun run = scene.run (
      noMask, everyFive (), std::make_shared<FakeSegmenter> ([] (const Eigen::Vector3d& p, int frame) {
        const int label = isThing (p, -0.15) && p.x () < 0.0 ? 1 : isThing (p, 0.15) ? 2 : 0;
        return label > 0 && frame == 10 ? 9 : label;
      }));
  EXPECT_EQ (run.found.size (), 2u);
  for (const int body : {1, 2})
    EXPECT_GT (imageIou (run, 12, body, run.foundAs (body)), 0.75) << body;
}

TEST (UnreliableMasks, PartsThatMoveAsOneAreUnited)
{
  TrackedScene scene (36);
  const KeyedMotion motion = along ({0.0, 0.3, 1.0}, {{-0.2, 0.0, 0.0}, {-0.2, 0.0, 0.0}, {0.25, 0.0, 0.0}});
  scene.addThing (1, motion);
  const TrackedRun run = scene.run (noMask, everyFive (),
                                    std::make_shared<FakeSegmenter> ([&] (const Eigen::Vector3d& p, int frame) {
                                      const double x = motion.at (frame / 36.0).translation ().x ();
                                      return !isThing (p, x) ? 0 : p.x () < x + 0.05 ? 1 : 2;
                                    }));
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_TRUE (run.said (" is a part of object "));
  EXPECT_GT (imageIou (run, 35, 1, run.foundAs (1)), 0.8);
}

TEST (UnreliableMasks, PartsThatAreUnitedBetweenMasksStayOne)
{
  for (const double end : {0.05, 0.25}) // the faster it moves, the sooner it is seen to be one
  {
    TrackedScene scene (36);
    const KeyedMotion motion = along ({0.0, 0.3, 1.0}, {{-0.2, 0.0, 0.0}, {-0.2, 0.0, 0.0}, {end, 0.0, 0.0}});
    scene.addThing (1, motion);
    const TrackedRun run = scene.run (noMask, everyFive (),
                                      std::make_shared<FakeSegmenter> ([&] (const Eigen::Vector3d& p, int frame) {
                                        const double x = motion.at (frame / 36.0).translation ().x ();
                                        return !isThing (p, x) ? 0 : p.x () < x + 0.05 ? 1 : 2;
                                      }));
    EXPECT_TRUE (run.said (" is a part of object ")) << end;
    EXPECT_FALSE (run.said ("object 3 begins")) << end;
    for (int frame = 23; frame < 36; ++frame)
      EXPECT_GT (imageIou (run, frame, 1, 1), 0.8) << end << ", frame " << frame;
  }
}

TEST (UnreliableMasks, WhatOneMaskShowedIsNoObject)
{
  TrackedScene scene (20);
  const TrackedRun run = scene.run (
      noMask, everyFive (), std::make_shared<FakeSegmenter> ([] (const Eigen::Vector3d& p, int frame) {
        return frame == 0 && std::hypot (p.x (), p.y ()) < 0.25 && p.z () < 0.1 ? 1 : 0; // of the floor
      }));
  EXPECT_TRUE (run.found.empty ());
  EXPECT_TRUE (run.said ("only one mask showed it"));
  for (const TrackedFrame& frame : run.frames)
    EXPECT_TRUE (frame.T_world_object.empty ());
  EXPECT_LT (run.shareOfBackgroundWrong (scene, 0.04), 0.01);
}

TEST (UnreliableMasks, WhatTheBorderCutsBeginsNoObject)
{
  TrackedScene scene (12);
  const TrackedRun run = scene.run (noMask, everyFive (),
                                    std::make_shared<FakeSegmenter> ([] (const Eigen::Vector3d& p, int) {
                                      return p.z () < 0.1 && p.y () < -0.3 ? 1 : 0; // the floor at the lower border
                                    }));
  EXPECT_TRUE (run.found.empty ());
}
