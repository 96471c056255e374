// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Objects that the front end finds by their motion alone.

#include "tracked_scene.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <gtest/gtest.h>

#include <memory>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double misled_limit_m = 0.03; // before bare walls, by a thing that moves and is not found yet
// Shares of the background: the surface that an object left before it was found vanishes as free space is averaged in;
// the surface at its place when it is found vanishes at once.
constexpr double left_behind_share = 0.03, inside_share = 0.004;

TrackedRun
runByMotion (const TrackedScene& scene)
{
  DynamicFusionOptions options;
  options.segment_every = 5;
  return scene.run (noMask, options, std::make_shared<MotionSegmenter> ());
}

/** \brief Intersection over union of a body and the object it was found as, in the last frame. */
double
overlap (const TrackedRun& run, std::uint16_t body)
{
  const auto id = static_cast<std::uint16_t> (run.foundAs (body));
  const Image<std::uint16_t>& labels = run.frames.back ().instances;
  const Image<std::uint16_t>& truth = run.masks.back ();
  double both = 0.0, either = 0.0;
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
  {
    both += labels.pixels[n] == id && truth.pixels[n] == body;
    either += labels.pixels[n] == id || truth.pixels[n] == body;
  }
  return id == 0 ? 0.0 : both / either;
}

} // namespace

TEST (MotionSegmenter, NothingMoves)
{
  TrackedScene scene (25);
  scene.moveCamera ({-0.1, -1.3, 0.9}, {0.1, -1.25, 0.95});
  scene.addThing (1, along ({0.0}, {{-0.2, 0.0, 0.0}}));
  const TrackedRun run = runByMotion (scene);
  EXPECT_TRUE (run.found.empty ());
  EXPECT_LT (run.cameraError (), segmented_camera_limit_m);
}

TEST (MotionSegmenter, AnObjectBeginsWhenItBeginsToMove)
{
  TrackedScene scene (40);
  scene.moveCamera ({-0.1, -1.3, 0.9}, {0.1, -1.25, 0.95});
  scene.addThing (1, along ({0.25, 1.0}, {{-0.25, 0.0, 0.0}, {0.15, 0.1, 0.0}}));
  scene.addThing (2, along ({0.0}, {{0.3, 0.3, 0.0}}));
  const TrackedRun run = runByMotion (scene);
  EXPECT_EQ (run.framesWithCamera (), 40);
  EXPECT_LT (run.cameraError (), misled_limit_m);
  ASSERT_EQ (run.found.size (), 1u);
  const int id = *run.found.begin ();
  EXPECT_EQ (run.foundAs (1), id);
  EXPECT_EQ (run.foundAs (2), 0);
  EXPECT_GE (overlap (run, 1), 0.85);
  EXPECT_LT (run.objectError (id, scene.body (1)), object_limit_m);
  EXPECT_LT (run.shareOfBackgroundInside (scene, 1, 0.02), inside_share);
}

TEST (MotionSegmenter, OfTwoThatTouchOneIsTakenAway)
{
  TrackedScene scene (40);
  scene.addThing (1, along ({0.25, 1.0}, {{-0.13, 0.0, 0.0}, {-0.35, -0.1, 0.1}}));
  scene.addThing (2, along ({0.0}, {{0.131, 0.0, 0.0}}));
  const TrackedRun run = runByMotion (scene);
  ASSERT_EQ (run.found.size (), 1u);
  EXPECT_EQ (run.foundAs (2), 0);
  EXPECT_GE (overlap (run, 1), 0.85);
  EXPECT_LT (run.objectError (*run.found.begin (), scene.body (1)), object_limit_m);
}

TEST (MotionSegmenter, TwoMotionsAreTwoObjects)
{
  TrackedScene scene (40);
  scene.addThing (1, along ({0.2, 1.0}, {{-0.3, 0.0, 0.0}, {-0.1, -0.2, 0.0}}));
  scene.addThing (2, along ({0.4, 1.0}, {{0.3, 0.2, 0.0}, {0.1, 0.0, 0.05}}));
  const TrackedRun run = runByMotion (scene);
  EXPECT_EQ (run.found.size (), 2u);
  EXPECT_NE (run.foundAs (1), run.foundAs (2));
  EXPECT_GE (overlap (run, 1), 0.85);
  EXPECT_GE (overlap (run, 2), 0.85);
  EXPECT_LT (run.shareOfBackgroundWrong (scene, wrong_m), left_behind_share);
}
