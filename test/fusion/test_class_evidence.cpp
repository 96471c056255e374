// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The class of an object, by many detections that may contradict each other.

#include "pcl_cosection/fusion/mapping/tracked_object.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr double rounding = 1e-12;

const ClassScore clear_cup = {41, "cup", 0.9}, faint_cup = {41, "cup", 0.5}, clear_bowl = {45, "bowl", 0.8};

ClassEvidence
evidenceOf (const std::vector<ClassScore>& detections)
{
  ClassEvidence evidence;
  for (const ClassScore& detection : detections)
    evidence.add (detection);
  return evidence;
}

} // namespace

TEST (ClassEvidence, WithoutADetectionNothingIsKnown)
{
  EXPECT_FALSE (ClassEvidence ().best ());
  EXPECT_EQ (ClassEvidence ().detections (), 0u);
}

TEST (ClassEvidence, OneDetectionIsBelieved)
{
  const ClassEvidence evidence = evidenceOf ({clear_bowl});
  ASSERT_TRUE (evidence.best ());
  EXPECT_EQ (evidence.best ()->class_id, 45);
  EXPECT_EQ (evidence.best ()->class_name, "bowl");
  EXPECT_EQ (evidence.best ()->score, 0.8);
}

TEST (ClassEvidence, TheScoreIsTheMeanOverAllDetections)
{
  const ClassEvidence evidence = evidenceOf ({clear_bowl, clear_cup, faint_cup});
  EXPECT_EQ (evidence.detections (), 3u);
  EXPECT_EQ (evidence.best ()->class_name, "cup");
  EXPECT_NEAR (evidence.best ()->score, (0.9 + 0.5) / 3.0, rounding);
}

TEST (ClassEvidence, ScoresDecideNotTheirNumber)
{
  const ClassScore hint = {7, "hat", 0.2};
  EXPECT_EQ (evidenceOf ({hint, hint, hint, clear_cup}).best ()->class_name, "cup");
  EXPECT_EQ (evidenceOf ({hint, hint, hint, hint, hint, clear_cup}).best ()->class_name, "hat");
}

TEST (ClassEvidence, OfEqualsTheSmallestNumberIsTaken)
{
  const ClassScore one = {1, "one", 0.5}, two = {2, "two", 0.5}, three = {3, "three", 0.5};
  std::vector<ClassScore> detections = {one, two, three};
  do
    EXPECT_EQ (evidenceOf (detections).best ()->class_id, 1);
  while (std::next_permutation (detections.begin (), detections.end (),
                                [] (const ClassScore& a, const ClassScore& b) { return a.class_id < b.class_id; }));
}

TEST (ClassEvidence, UnitedObjectsHaveAllDetections)
{
  ClassEvidence united = evidenceOf ({clear_cup, clear_bowl});
  united.add (evidenceOf ({clear_bowl, clear_bowl, faint_cup}));
  EXPECT_EQ (united.detections (), 5u);
  EXPECT_EQ (united.best ()->class_name, "bowl");
  EXPECT_NEAR (united.best ()->score, 3.0 * 0.8 / 5.0, rounding);
  united.add (ClassEvidence ());
  EXPECT_EQ (united.detections (), 5u);
  ClassEvidence nothing;
  nothing.add (united);
  EXPECT_EQ (nothing.best ()->score, united.best ()->score);
}

TEST (ClassEvidence, WhatIsNoScoreIsRefused)
{
  ClassEvidence evidence = evidenceOf ({clear_cup});
  for (const double score :
       {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN (), std::numeric_limits<double>::infinity ()})
    EXPECT_THROW (evidence.add (ClassScore{1, "", score}), InvalidArgument) << score;
  EXPECT_EQ (evidence.detections (), 1u);
  EXPECT_EQ (evidence.best ()->score, 0.9);
}
