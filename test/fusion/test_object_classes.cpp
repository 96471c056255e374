// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Classes of objects, with segmenters that name the classes of instances.

#include "tracked_scene.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double score_rounding = 1e-9;
constexpr int frames_per_mask = 5;

const ClassScore cup_score = {41, "cup", 0.9}, bowl_score = {45, "bowl", 0.8}, part_score = {7, "part", 0.6};

TrackedRun
runWith (const TrackedScene& scene, bool exact, FakeSegmenter::Label label, FakeSegmenter::Classes classes,
         const MaskPolicy& masks = noMask)
{
  DynamicFusionOptions options;
  options.segment_every = frames_per_mask;
  return scene.run (masks, options, std::make_shared<FakeSegmenter> (std::move (label), exact, std::move (classes)));
}

} // namespace

TEST (ObjectClasses, DetectionsAreCountedForTheObjectsThatTheyShow)
{
  TrackedScene scene (4 * frames_per_mask);
  scene.addThing (1, along ({0.0}, {{-0.3, 0.0, 0.0}}));
  scene.addThing (2, along ({0.0}, {{0.3, 0.0, 0.0}}));
  // Instances have other numbers in each mask. The last one has no class for the left thing.
  const auto left = [] (int frame) { return 1 + frame % 2; };
  const TrackedRun run = runWith (
      scene, true,
      [&] (const Eigen::Vector3d& p, int frame) {
        return isThing (p, -0.3) ? left (frame) : isThing (p, 0.3) ? 3 - left (frame) : 0;
      },
      [&] (int frame) {
        std::map<std::uint16_t, ClassScore> classes = {{3 - left (frame), part_score}, {99, cup_score}};
        if (frame < 3 * frames_per_mask)
          classes[left (frame)] = frame == frames_per_mask ? bowl_score : cup_score;
        return classes;
      });
  ASSERT_EQ (run.found.size (), 2u);
  ASSERT_EQ (run.classes.size (), 2u);
  const ClassScore& of_left = run.classes.at (run.foundAs (1));
  EXPECT_EQ (of_left.class_id, 41);
  EXPECT_EQ (of_left.class_name, "cup");
  EXPECT_NEAR (of_left.score, (0.9 + 0.9) / 3.0, score_rounding);
  EXPECT_EQ (run.classes.at (run.foundAs (2)).class_name, "part");
  EXPECT_NEAR (run.classes.at (run.foundAs (2)).score, 0.6, score_rounding);
}

TEST (ObjectClasses, WithoutNamesNothingIsKnown)
{
  TrackedScene scene (2);
  scene.addThing (1, along ({0.0}, {{0.0, 0.0, 0.0}}));
  const auto label = [] (const Eigen::Vector3d& p, int) { return isThing (p, 0.0) ? 1 : 0; };
  const TrackedRun unnamed = runWith (scene, true, label, [] (int) { return std::map<std::uint16_t, ClassScore> (); });
  EXPECT_EQ (unnamed.found.size (), 1u);
  EXPECT_TRUE (unnamed.classes.empty ());
  // Masks from files have no classes, whatever a segmenter would say.
  const auto named = [] (int) { return std::map<std::uint16_t, ClassScore>{{1, cup_score}}; };
  const TrackedRun masked = runWith (scene, true, label, named,
                                     [] (int, const Image<std::uint16_t>& truth) { return std::optional (truth); });
  EXPECT_EQ (masked.found.size (), 1u);
  EXPECT_TRUE (masked.classes.empty ());
}

TEST (ObjectClasses, APartThatOneMaskShowsSaysNothingOfTheWhole)
{
  TrackedScene scene (4 * frames_per_mask + 1);
  scene.addThing (1, along ({0.0}, {{0.0, 0.0, 0.0}}));
  const TrackedRun run = runWith (
      scene, false,
      [] (const Eigen::Vector3d& p, int frame) {
        return !isThing (p, 0.0) ? 0 : frame == 2 * frames_per_mask && p.x () > 0.08 ? 7 : 3;
      },
      [] (int) {
        return std::map<std::uint16_t, ClassScore>{{3, cup_score}, {7, part_score}};
      });
  ASSERT_EQ (run.found.size (), 1u);
  ASSERT_EQ (run.classes.size (), 1u);
  EXPECT_EQ (run.classes.begin ()->second.class_name, "cup");
  EXPECT_NEAR (run.classes.begin ()->second.score, 0.9, score_rounding);
}

TEST (ObjectClasses, UnitedPartsHaveTheDetectionsOfBoth)
{
  TrackedScene scene (36);
  const KeyedMotion motion = along ({0.0, 0.3, 1.0}, {{-0.2, 0.0, 0.0}, {-0.2, 0.0, 0.0}, {0.25, 0.0, 0.0}});
  scene.addThing (1, motion);
  const TrackedRun run = runWith (
      scene, false,
      [&] (const Eigen::Vector3d& p, int frame) {
        return !isThing (p, motion.at (frame / 36.0).translation ().x ()) ? 0
               : p.z () < 0.09                                            ? 1
                                                                          : 2; // well below the box's top
      },
      [] (int) {
        return std::map<std::uint16_t, ClassScore>{{1, cup_score}, {2, part_score}};
      });
  ASSERT_EQ (run.found.size (), 1u);
  ASSERT_TRUE (run.said (" is a part of object "));
  ASSERT_EQ (run.classes.size (), 1u);
  const ClassScore& united = run.classes.begin ()->second;
  // The upper part is most of the thing in the image, so that it remains; the detections of the lower one name another
  // class.
  EXPECT_EQ (united.class_name, "part");
  EXPECT_LT (united.score, 0.6 - score_rounding);
  EXPECT_GT (united.score, 0.3);
}

TEST (ObjectClasses, WhatIsGivenUpIsNothing)
{
  TrackedScene scene (20);
  const TrackedRun run = runWith (
      scene, false,
      [] (const Eigen::Vector3d& p, int frame) {
        return frame == 0 && std::hypot (p.x (), p.y ()) < 0.25 && p.z () < 0.1 ? 1 : 0;
      },
      [] (int) {
        return std::map<std::uint16_t, ClassScore>{{1, cup_score}};
      });
  ASSERT_TRUE (run.said ("only one mask showed it"));
  EXPECT_TRUE (run.found.empty ());
  EXPECT_TRUE (run.classes.empty ());
}

TEST (ObjectClasses, WhatIsNoScoreIsRefused)
{
  TrackedScene scene (1);
  for (const double score : {-0.5, 1.5, std::numeric_limits<double>::quiet_NaN ()})
    EXPECT_THROW (runWith (
                      scene, true, [] (const Eigen::Vector3d&, int) { return 0; },
                      [score] (int) {
                        return std::map<std::uint16_t, ClassScore>{{1, {1, "cup", score}}};
                      }),
                  InvalidArgument)
        << score;
}
