// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace pcl::cosection;

TEST (StampMatching, NearestIsThatOfASearchThroughAll)
{
  std::mt19937 random (1);
  std::uniform_int_distribution<int> step (1, 9), any (-10, 300);
  std::vector<double> stamps;
  for (double stamp = 0; stamps.size () < 40; stamp += step (random))
    stamps.push_back (stamp);
  for (int n = 0; n < 500; ++n)
  {
    const double stamp = any (random);
    std::size_t expected = 0;
    for (std::size_t i = 1; i < stamps.size (); ++i)
      if (std::abs (stamps[i] - stamp) < std::abs (stamps[expected] - stamp))
        expected = i;
    const double distance = std::abs (stamps[expected] - stamp);
    EXPECT_EQ (nearestStamp (stamps, stamp, distance + 0.5), expected);
    EXPECT_FALSE (nearestStamp (stamps, stamp, distance));
  }
  EXPECT_FALSE (nearestStamp ({}, 0.0, 1.0));
  EXPECT_FALSE (nearestStamp (stamps, std::numeric_limits<double>::quiet_NaN (), 1.0));
}

TEST (StampMatching, ThePeriodIsTheMedianDifference)
{
  EXPECT_EQ (stampPeriod ({}), 1.0);
  EXPECT_EQ (stampPeriod ({7.0}), 1.0);
  EXPECT_EQ (stampPeriod ({7.0, 9.0}), 2.0);
  EXPECT_EQ (stampPeriod ({0, 1, 2, 50, 51, 52}), 1.0);
}

TEST (StampMatching, GapsOfATrajectoryStayGaps)
{
  std::vector<StampedPose> trajectory (4);
  const double stamps[] = {0.01, 0.99, 2.0, 6.3};
  for (int n = 0; n < 4; ++n)
  {
    trajectory[n].stamp = stamps[n];
    trajectory[n].pose.translation ().x () = n;
  }
  const auto poses = posesAtStamps (trajectory, {-1, 0, 1, 2, 3, 4, 5, 6, 7}, 1.0);
  ASSERT_EQ (poses.size (), 9u);
  const double nothing = -1.0;
  const double expected[] = {nothing, 0, 1, 2, nothing, nothing, nothing, 3, nothing};
  for (std::size_t n = 0; n < 9; ++n)
  {
    ASSERT_EQ (poses[n].has_value (), expected[n] != nothing) << n;
    EXPECT_EQ (poses[n] ? poses[n]->translation ().x () : nothing, expected[n]);
  }
  EXPECT_FALSE (posesAtStamps ({}, {0.0}, 1.0)[0]);
  EXPECT_TRUE (posesAtStamps (trajectory, {}, 1.0).empty ());
  for (const double period : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN ()})
    EXPECT_THROW (posesAtStamps (trajectory, {0.0}, period), InvalidArgument);
}
