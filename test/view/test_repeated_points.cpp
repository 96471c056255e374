// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Points that merged clouds hold more than once.

#include "pcl_cosection/view/outliers/repeated_points.h"

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;

namespace {

/** \brief Points of one label, at random on a square of a metre. */
SensorCloud
randomSquare (std::size_t count)
{
  std::mt19937 random (3);
  std::uniform_real_distribution<float> along (0.0f, 1.0f);
  SensorCloud cloud;
  for (std::size_t i = 0; i < count; ++i)
    cloud.positions.emplace_back (along (random), along (random), 1.0f);
  cloud.labels.assign (count, 1);
  return cloud;
}

/** \brief The points once more, each moved by up to \a shift_m along each axis. */
void
repeat (SensorCloud& cloud, float shift_m, std::uint32_t label = 1)
{
  std::mt19937 random (4);
  std::uniform_real_distribution<float> shift (-shift_m, shift_m);
  const std::vector<Eigen::Vector3f> once = cloud.positions;
  for (const Eigen::Vector3f& p : once)
    cloud.positions.emplace_back (p + Eigen::Vector3f (shift (random), shift (random), shift (random)));
  cloud.labels.resize (cloud.positions.size (), label);
}

std::size_t
left (const SensorCloud& cloud)
{
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : cloud.positions)
    count += p.allFinite ();
  return count;
}

} // namespace

TEST (RepeatedPoints, CountOnce)
{
  SensorCloud cloud = randomSquare (5000);
  repeat (cloud, 0.0f);
  EXPECT_DOUBLE_EQ (leaveOutRepeated (2, cloud), 0.5);
  EXPECT_EQ (left (cloud), 5000u);
  EXPECT_TRUE (cloud.positions.front ().allFinite ()); // the first stays
}

TEST (RepeatedPoints, OfAFewTimesToo)
{
  SensorCloud cloud = randomSquare (1000);
  const SensorCloud once = cloud;
  for (int round = 0; round < 4; ++round)
    repeat (cloud, 0.0f);
  leaveOutRepeated (1, cloud);
  EXPECT_EQ (left (cloud), 1000u);
  EXPECT_TRUE (std::equal (once.positions.begin (), once.positions.end (), cloud.positions.begin ()));
}

TEST (RepeatedPoints, NearlyTheSameCountOnce)
{
  SensorCloud cloud = randomSquare (5000); // 14 mm apart
  repeat (cloud, 1e-4f);
  leaveOutRepeated (2, cloud);
  EXPECT_NEAR (static_cast<double> (left (cloud)), 5000.0, 100.0); // a few were as near by chance
}

TEST (RepeatedPoints, WhatIsNearByChanceIsKept)
{
  SensorCloud cloud = randomSquare (5000);
  EXPECT_EQ (leaveOutRepeated (2, cloud), 0.0);
  EXPECT_EQ (left (cloud), 5000u);
}

TEST (RepeatedPoints, OfTwoLabelsAreKept)
{
  SensorCloud cloud = randomSquare (500);
  repeat (cloud, 0.0f, 2);
  EXPECT_EQ (leaveOutRepeated (1, cloud), 0.0);
}

TEST (RepeatedPoints, FewerThanAnyStayAsTheyAre)
{
  SensorCloud cloud;
  EXPECT_EQ (leaveOutRepeated (1, cloud), 0.0);
  cloud = randomSquare (1);
  EXPECT_EQ (leaveOutRepeated (1, cloud), 0.0);
}
