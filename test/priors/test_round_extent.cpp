// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// ProfiledShape of surfaces of revolution, and of other things whose copies are reliable.

#include "moved_points.h"
#include "observed_box.h"
#include "round_things.h"

#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double reach = 0.004;

/** \brief 20 cm high, with shoulders and a neck. */
std::pair<double, double>
bottle (double height)
{
  if (height < 0.12)
    return {0.04, 0.0};
  if (height < 0.16)
    return {0.04 - 0.65 * (height - 0.12), -0.65};
  return {0.014, 0.0};
}

} // namespace

class RoundInAnyPose : public testing::TestWithParam<bool>
{};

TEST_P (RoundInAnyPose, BottleIsRoundAllAround)
{
  std::vector<OrientedPoint> points = moved (observedRound (bottle, 0.0, 0.2, {0.0, -1.0, 0.3}), anyPose ());
  if (GetParam ())
    points = noisy (points);
  const double tolerance = GetParam () ? 0.006 : 0.001;
  const ProfiledShape extent (points);
  EXPECT_TRUE (extent);
  const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, reach);
  EXPECT_EQ (sectorsOf (hidden, anyPose (), 0.01, 0.05), 36);
  EXPECT_EQ (sectorsOf (hidden, anyPose (), 0.17, 0.19), 36);
  std::size_t wrong = 0;
  for (const OrientedPoint& point : hidden)
  {
    const Eigen::Vector3d p = anyPose ().inverse () * point.position.cast<double> ();
    if (p.z () < 0.005 || p.z () > 0.195) // ends
      continue;
    wrong += std::abs (p.head<2> ().norm () - bottle (p.z ()).first) > tolerance;
  }
  EXPECT_LT (wrong, hidden.size () / 50);
}

INSTANTIATE_TEST_SUITE_P (Measured, RoundInAnyPose, testing::Bool (),
                          [] (const auto& info) { return info.param ? "Noisy" : "Exact"; });

// Normals of depth images lean towards the camera, as they are means over patches that end where the thing does.
TEST_P (RoundInAnyPose, LeaningNormalsDoNotMoveTheAxis)
{
  const Eigen::Vector3d view (0.0, -0.95, 0.3);
  for (const Profile& profile : {Profile (can), Profile (bottle)})
  {
    std::vector<OrientedPoint> points = observedRound (profile, 0.0, 0.2, view);
    for (OrientedPoint& point : points)
      point.normal = (point.normal + 0.15f * view.cast<float> ()).normalized ();
    points = moved (GetParam () ? noisy (points) : points, anyPose ());
    const Eigen::Vector3d up = anyPose ().linear () * Eigen::Vector3d::UnitZ ();
    const Eigen::Vector4d plane (up.x (), up.y (), up.z (), -up.dot (anyPose ().translation ()));
    const Eigen::Vector3d standing = anyPose ().inverse () * ProfiledShape (points, plane).center ();
    EXPECT_LT (standing.head<2> ().norm (), 0.001);
    const Eigen::Vector3d lifted = anyPose ().inverse () * ProfiledShape (points).center ();
    EXPECT_LT (lifted.head<2> ().norm (), 0.0015);
  }
}

TEST (RoundExtent, HandlesAreNotTurned)
{
  std::vector<OrientedPoint> points = observedRound (can, 0.0, 0.09, {0.0, -1.0, 0.3});
  for (double angle = -1.2; angle < 1.2; angle += 0.05) // its outer edge, in a plane with the axis
    for (double y = -0.004; y < 0.004; y += 0.001)
    {
      const Eigen::Vector3d out (std::cos (angle), 0.0, std::sin (angle));
      points.push_back (pointAt (Eigen::Vector3d (0.045, y, 0.045) + 0.03 * out, out));
    }
  const ProfiledShape extent (points);
  ASSERT_TRUE (extent);
  const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, reach);
  ASSERT_FALSE (hidden.empty ());
  for (const OrientedPoint& p : hidden)
    EXPECT_LT (p.position.head<2> ().norm (), 0.045f);
}

TEST (RoundExtent, BallsAreRoundBelowToo)
{
  constexpr double radius = 0.06;
  const Profile ball = [&] (double height) {
    const double r = std::sqrt (std::max (1e-9, radius * radius - height * height));
    return std::pair (r, -height / r);
  };
  const std::vector<OrientedPoint> points = observedRound (ball, -radius + 0.001, radius - 0.001, {0.0, -0.3, 0.95});
  const ProfiledShape extent (points);
  EXPECT_TRUE (extent);
  EXPECT_LT (extent.center ().norm (), 0.002);
  const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, reach);
  EXPECT_TRUE (std::any_of (hidden.begin (), hidden.end (),
                            [&] (const OrientedPoint& p) { return p.position.z () < -0.95 * radius; }));
  for (const OrientedPoint& p : hidden)
    EXPECT_NEAR (p.position.norm (), radius, 0.002);
}

TEST (RoundExtent, NoiseHidesNoBall)
{
  constexpr double radius = 0.04; // of some 600 points, as a camera sees it from 1.4 m
  std::mt19937 random (1);
  std::normal_distribution<float> normal;
  std::vector<OrientedPoint> points;
  const Eigen::Vector3d view = Eigen::Vector3d (1.0, 0.0, 0.5).normalized ();
  while (points.size () < 600)
  {
    const Eigen::Vector3d n = Eigen::Vector3d (normal (random), normal (random), normal (random)).normalized ();
    if (n.dot (view) < 0.25)
      continue;
    OrientedPoint point = pointAt (radius * n + 0.003 * normal (random) * view, n);
    point.normal = (point.normal + 0.12f * Eigen::Vector3f (normal (random), normal (random), normal (random)))
                       .normalized ();
    points.push_back (point);
  }
  for (const ProfiledShape& extent : {ProfiledShape (points), ProfiledShape (points, {0.0, 0.0, 1.0, radius})})
  {
    ASSERT_TRUE (extent);
    EXPECT_LT (extent.center ().norm (), 0.003);
    const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, 0.01);
    const auto behind = [&] (const OrientedPoint& p) { return p.position.cast<double> ().dot (view) < -0.8 * radius; };
    EXPECT_GT (std::count_if (hidden.begin (), hidden.end (), behind), 20);
  }
}

TEST (RoundExtent, EggsAreNoBalls)
{
  constexpr double radius = 0.05, half_length = 0.065;
  const Profile egg = [&] (double height) {
    const double r = radius * std::sqrt (std::max (1e-9, 1.0 - std::pow (height / half_length, 2)));
    return std::pair (r, -height * std::pow (radius / half_length, 2) / r);
  };
  const std::vector<OrientedPoint> points = observedRound (egg, -half_length + 0.001, half_length - 0.001,
                                                           Eigen::Vector3d (0.3, -0.9, 0.3).normalized ());
  const ProfiledShape extent (points);
  ASSERT_TRUE (extent);
  for (const OrientedPoint& p : extent.hiddenSide (points, reach))
  {
    const Eigen::Array3d q = p.position.cast<double> ().array () / Eigen::Array3d (radius, radius, half_length);
    EXPECT_NEAR (q.matrix ().norm (), 1.0, 0.03);
  }
}

TEST (RoundExtent, BowlsAndDomesAreNoBalls)
{
  constexpr double radius = 0.06;
  const auto half = [&] (double middle) {
    return [middle] (double height) {
      const double h = height - middle;
      const double r = std::sqrt (std::max (1e-9, radius * radius - h * h));
      return std::pair (r, -h / r);
    };
  };
  const Eigen::Vector3d view (0.0, -0.8, 0.6);
  // Cut at their middle: open upwards, seen from outside and inside; and standing on the cut.
  std::vector<OrientedPoint> bowl = observedRound (half (radius), 0.002, radius, view);
  const std::vector<OrientedPoint> inside = observedRound (half (radius), 0.002, radius, view, -1.0);
  bowl.insert (bowl.end (), inside.begin (), inside.end ());
  const std::vector<OrientedPoint> dome = observedRound (half (0.0), 0.0, radius - 0.001, view);
  for (const OrientedPoint& p : ProfiledShape (bowl, ground).hiddenSide (bowl, reach))
    EXPECT_LT (p.position.z (), radius + 0.002);
  for (const OrientedPoint& p : ProfiledShape (dome, ground).hiddenSide (dome, reach))
    EXPECT_GT (p.position.z (), -0.002);
}

TEST (RoundExtent, WhatTellsNothingIsNotRound)
{
  const std::vector<OrientedPoint> one_place (100, pointAt ({0.1, 0.1, 0.1}, {0.0, 0.0, 1.0}));
  EXPECT_FALSE (ProfiledShape (one_place));
  const std::vector<OrientedPoint> plate = observedBox ({0.1, 0.1, 0.001}, {0.0, 0.0, 1.0});
  EXPECT_FALSE (ProfiledShape (plate));
  const std::vector<OrientedPoint> strip = observedRound (can, 0.0, 0.1, {0.0, -0.1155, 0.0}); // 60 degrees of a can
  EXPECT_FALSE (ProfiledShape (strip));
}
