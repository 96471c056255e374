// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The front end with a segmenter that finds objects while it tracks.

#include "tracked_scene.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Labels what stands on the middle of the floor. */
class MiddleOfFloor : public FrameSegmenter
{
public:
  explicit MiddleOfFloor (std::uint16_t label = 0) : label_ (label) {}

  void begin () override { looked = asked = 0; }

  void look (const ObservedFrame&) override { ++looked; }

  FrameInstances segment (const ObservedFrame& frame) override
  {
    ++asked;
    if (silent)
      return {std::nullopt, "it says nothing"};
    tracked = frame.T_world_object.size ();
    FrameInstances found;
    found.mask = Image<std::uint16_t> (frame.camera.width, frame.camera.height, 0);
    for (std::size_t n = 0; n < frame.points.size (); ++n)
    {
      const Eigen::Vector3d p = frame.T_world_camera * frame.points[n].cast<double> ();
      if (p.z () > 0.02 && std::abs (p.x ()) < 0.6 && std::abs (p.y ()) < 0.5)
        found.mask->pixels[n] = label_ > 0 ? label_ : static_cast<std::uint16_t> (3 + frame.images.index);
      unassigned += frame.labels.pixels[n] == TrackedFrame::unassigned;
      moving += frame.moving.pixels[n];
    }
    return found;
  }

  int looked = 7, asked = 7;
  std::size_t tracked = 0;    // objects, when it was asked last
  std::size_t unassigned = 0; // pixels
  std::size_t moving = 0;
  bool silent = false;

private:
  std::uint16_t label_; // 0: another one in each frame
};

class WrongSize : public FrameSegmenter
{
public:
  FrameInstances segment (const ObservedFrame&) override { return {Image<std::uint16_t> (4, 4), ""}; }
};

} // namespace

TEST (FrameSegmenter, ItsInstancesBecomeObjectsThatAreTracked)
{
  TrackedScene scene (24);
  scene.moveCamera ({-0.1, -1.3, 0.9}, {0.1, -1.25, 0.95});
  scene.addThing (1, movingThing ({-0.2, 0.0, 0.0}, {0.1, 0.1, 0.0}, 0.5));
  const auto segmenter = std::make_shared<MiddleOfFloor> ();
  DynamicFusionOptions options;
  options.segment_every = 8;
  const TrackedRun run = scene.run (noMask, options, segmenter);
  EXPECT_EQ (segmenter->asked, 3);
  EXPECT_EQ (segmenter->looked, 21);
  EXPECT_EQ (segmenter->tracked, 1u);
  EXPECT_EQ (run.found.size (), 1u);
  EXPECT_LT (run.cameraError (), segmented_camera_limit_m);
  ASSERT_EQ (run.framesOf (1), 24);
  EXPECT_LT (run.objectError (1, scene.body (1)), object_limit_m);
  for (int n = 0; n < 24; ++n)
    EXPECT_EQ (run.frames[n].masked, n % 8 == 0) << n;
}

TEST (FrameSegmenter, GivenMasksComeFirst)
{
  TrackedScene scene (4);
  scene.addThing (1, movingThing ({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0));
  const auto segmenter = std::make_shared<MiddleOfFloor> ();
  const TrackedRun run = scene.run ([] (int, const Image<std::uint16_t>& truth) { return std::optional (truth); }, {},
                                    segmenter);
  EXPECT_EQ (segmenter->asked, 0);
  EXPECT_EQ (run.found.size (), 1u);
}

TEST (FrameSegmenter, ItIsToldWhatMovesAndWhatNobodyExplains)
{
  TrackedScene scene (21);
  scene.addThing (1, movingThing ({-0.9, 0.0, 0.0}, {0.4, 0.0, 0.0}, 0.0));
  const auto segmenter = std::make_shared<MiddleOfFloor> (FrameSegmenter::ignored);
  scene.run (noMask, {}, segmenter);
  EXPECT_GT (segmenter->unassigned, 100u);
  EXPECT_GT (segmenter->moving, 100u);
}

TEST (FrameSegmenter, WhatItCannotTellIsToldOnce)
{
  TrackedScene scene (21);
  const auto segmenter = std::make_shared<MiddleOfFloor> ();
  segmenter->silent = true;
  const TrackedRun run = scene.run (noMask, {}, segmenter);
  EXPECT_EQ (segmenter->asked, 3);
  ASSERT_EQ (run.events.size (), 1u);
  EXPECT_NE (run.events[0].find ("it says nothing"), std::string::npos);
  for (const TrackedFrame& frame : run.frames)
    EXPECT_FALSE (frame.masked);
}

TEST (FrameSegmenter, WhatIsToBeIgnoredIsNeitherTrackedWithNorMapped)
{
  // It rests at first, so that only the segmenter distinguishes it from the background.
  TrackedScene scene (30);
  scene.addPerson (1, along ({0.0, 0.5, 1.0}, {{0.15, 0.0, 0.0}, {0.15, 0.0, 0.0}, {-0.2, 0.1, 0.0}}));
  const TrackedRun run = scene.run (noMask, {}, std::make_shared<MiddleOfFloor> (FrameSegmenter::ignored));
  EXPECT_EQ (run.framesWithCamera (), 30);
  EXPECT_LT (run.cameraError (), segmented_camera_limit_m);
  EXPECT_TRUE (run.found.empty ());
  // Only its outline is mapped, where pixels are mixed.
  EXPECT_LT (run.shareOfBackgroundInside (scene, 1, 0.03),
             0.25 * scene.run (noMask).shareOfBackgroundInside (scene, 1, 0.03));
  for (int n = 0; n < 30; ++n)
    for (std::size_t pixel = 0; pixel < run.masks[n].pixels.size (); ++pixel)
      ASSERT_TRUE (run.frames[n].instances.pixels[pixel] == 0 ||
                   run.frames[n].instances.pixels[pixel] == TrackedFrame::unassigned);
}

TEST (FrameSegmenter, MasksOfAnotherSizeAreRefused)
{
  TrackedScene scene (2);
  EXPECT_THROW (scene.run (noMask, {}, std::make_shared<WrongSize> ()), InvalidArgument);
  DynamicFusionOptions options;
  options.segment_every = 0;
  EXPECT_THROW (options.validate (), InvalidArgument);
}
