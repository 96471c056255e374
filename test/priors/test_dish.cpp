// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// ProfiledShape of plates and dishes, which show only their inside, and of things that are open at the bottom.

#include "completion/scenes/surrounding_views.h"
#include "moved_points.h"
#include "observed_box.h"
#include "round_things.h"

#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double floor_radius = 0.06, rim_radius = 0.1;

/** \brief A plate as seen from above: a horizontal floor, and around it a straight wall that rises by \a depth. */
std::vector<OrientedPoint>
observedPlate (double floor, double depth)
{
  const double slope = (rim_radius - floor_radius) / depth;
  const Profile inside = [&] (double height) { return std::pair (floor_radius + slope * (height - floor), slope); };
  std::vector<OrientedPoint> points = observedRound (inside, floor, floor + depth, Eigen::Vector3d::UnitZ (), -1.0);
  for (double radius = 0.001; radius < floor_radius; radius += 0.002)
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.002 / radius)
      points.push_back (
          pointAt ({radius * std::cos (angle), radius * std::sin (angle), floor}, Eigen::Vector3d::UnitZ ()));
  return points;
}

/** \brief A square tray with the floor and the walls of the plate. */
std::vector<OrientedPoint>
observedTray (double floor, double depth)
{
  std::vector<OrientedPoint> points;
  const Eigen::Vector3d wall = Eigen::Vector3d (-depth, 0.0, rim_radius - floor_radius)
                                   .normalized (); // its normal in the direction of x
  for (double x = -rim_radius; x <= rim_radius; x += 0.002)
    for (double y = -rim_radius; y <= rim_radius; y += 0.002)
    {
      const double out = std::max (std::abs (x), std::abs (y));
      const double up = depth * std::max (0.0, out - floor_radius) / (rim_radius - floor_radius);
      const Eigen::Vector3d away = std::abs (x) > std::abs (y) ? Eigen::Vector3d (std::copysign (1.0, x), 0.0, 0.0)
                                                               : Eigen::Vector3d (0.0, std::copysign (1.0, y), 0.0);
      points.push_back (
          pointAt ({x, y, floor + up}, out > floor_radius
                                           ? Eigen::Vector3d (wall.x () * away + wall.z () * Eigen::Vector3d::UnitZ ())
                                           : Eigen::Vector3d::UnitZ ()));
    }
  return points;
}

/** \brief A cup 9 cm high with a wall of 4 mm, closed below, seen from both sides. */
std::vector<OrientedPoint>
wholeCup (double inner_end)
{
  std::vector<OrientedPoint> points;
  const Profile inside = [] (double /*height*/) { return std::pair (0.036, 0.0); };
  for (const double y : {-1.0, 1.0})
  {
    const Eigen::Vector3d view (0.0, y, 0.3);
    const std::vector<OrientedPoint> outer = observedRound (can, 0.0, 0.09, view),
                                     inner = observedRound (inside, 0.004, inner_end, view, -1.0);
    points.insert (points.end (), outer.begin (), outer.end ());
    points.insert (points.end (), inner.begin (), inner.end ());
  }
  for (double radius = 0.001; radius < 0.036; radius += 0.002)
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.002 / radius)
      points.push_back (
          pointAt ({radius * std::cos (angle), radius * std::sin (angle), 0.004}, Eigen::Vector3d::UnitZ ()));
  return points;
}

/** \brief Number of expected points in a disc about the axis at a height, for a thing at \a pose. */
std::ptrdiff_t
discAt (double height, const ProfiledShape& extent, const std::vector<OrientedPoint>& points,
        const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity ())
{
  const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, 0.002);
  return std::count_if (hidden.begin (), hidden.end (), [&] (const OrientedPoint& p) {
    const Eigen::Vector3d q = pose.inverse () * p.position.cast<double> ();
    return q.head<2> ().norm () < 0.02 && std::abs (q.z () - height) < 0.001;
  });
}

} // namespace

// 0.015 over 0.04: normals face sideways by 20 degrees only.
TEST (Dish, APlateIsAsThickAsItsFloorIsHigh)
{
  for (const double depth : {0.015, 0.03, 0.06})
    for (const double floor : {0.003, 0.006})
    {
      const std::vector<OrientedPoint> points = noisy (observedPlate (floor, depth));
      const ProfiledShape plate (points, ground);
      ASSERT_TRUE (plate) << depth;
      EXPECT_NEAR (plate.wallThickness (), floor, 0.0005) << depth;
      EXPECT_LT (plate.center ().head<2> ().norm (), 0.001) << depth;
      // Under the middle of the wall its outer side is expected, a wall's thickness from the inner one.
      const Eigen::Vector2d wall = Eigen::Vector2d (rim_radius - floor_radius, depth).normalized ();
      std::ptrdiff_t under = 0;
      for (const OrientedPoint& p : plate.hiddenSide (points, 0.001))
        if (std::abs (p.position.head<2> ().norm () - 0.08f) < 0.001f && p.normal.z () < 0.0f)
        {
          ++under;
          const double across = wall.x () * (p.position.z () - floor - 0.5 * depth) -
                                wall.y () * (p.position.head<2> ().norm () - 0.08);
          EXPECT_NEAR (-across, floor, 0.002) << depth;
          EXPECT_EQ (plate.partOf (p), VesselPart::Outer);
        }
      EXPECT_GT (under, 100) << depth;
      EXPECT_GT (discAt (0.0, plate, points), 100);
    }
}

TEST (Dish, WhatIsNoneIsLeftAlone)
{
  EXPECT_EQ (ProfiledShape (observedTray (0.004, 0.02), ground).wallThickness (), 0.0);
  EXPECT_EQ (ProfiledShape (observedPlate (0.04, 0.02), ground).wallThickness (),
             0.0); // on something, or a solid pedestal
}

TEST (Dish, AloneItIsNoLid)
{
  EXPECT_EQ (ProfiledShape (observedPlate (0.0, 0.02), false).wallThickness (),
             0.0); // something is known around it, but no plane
  const Profile recess = [] (double /*height*/) { return std::pair (floor_radius, 0.0); };
  std::vector<OrientedPoint> tin = observedRound (recess, 0.0, 0.006, Eigen::Vector3d (0.3, 0.0, 1.0), -1.0);
  for (double radius = 0.001; radius < floor_radius + 0.004; radius += 0.001)
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.001 / radius)
      tin.push_back (
          pointAt ({radius * std::cos (angle), radius * std::sin (angle), radius > floor_radius ? 0.006 : 0.0},
                   Eigen::Vector3d::UnitZ ()));
  EXPECT_EQ (ProfiledShape (tin).wallThickness (), 0.0);
}

// Rings of equally many points on profiles with steps: some distant places have equal sums of radius and height.
TEST (Dish, AnyStepsWillDo)
{
  std::mt19937 random (1);
  const auto between = [&random] (double low, double high) {
    return std::uniform_real_distribution<double> (low, high) (random);
  };
  for (int thing = 0; thing < 200; ++thing)
  {
    std::vector<OrientedPoint> points;
    Eigen::Vector2d end (0.0, between (0.0, 0.1)); // radius, height
    const int turns = 10 + static_cast<int> (between (0.0, 60.0));
    for (int step = 0; step < 6; ++step)
    {
      const Eigen::Vector2d start = end;
      end = {std::max (0.001, end.x () + between (-0.01, 0.05)), end.y () + between (-0.05, 0.05)};
      const Eigen::Vector2d along = (end - start).normalized ();
      for (int n = 0; n < 10 * turns; ++n)
      {
        const Eigen::Vector2d at = start + (n / turns) / 10.0 * (end - start);
        const Eigen::Vector3d out (std::cos (2.0 * M_PI * n / turns), std::sin (2.0 * M_PI * n / turns), 0.0);
        points.push_back (pointAt (at.x () * out + at.y () * Eigen::Vector3d::UnitZ (),
                                   -along.y () * out + along.x () * Eigen::Vector3d::UnitZ ()));
      }
    }
    for (const ProfiledShape& extent : {ProfiledShape (points), ProfiledShape (points, ground)})
      for (const OrientedPoint& p : extent.hiddenSide (points, 0.002))
        ASSERT_TRUE (p.position.allFinite () && p.normal.allFinite ()) << thing;
  }
}

TEST (Dish, OnNothingThatIsKnownItsWallIsAsUsual)
{
  for (const Eigen::Isometry3d& pose :
       {Eigen::Isometry3d (Eigen::Isometry3d::Identity ()), Eigen::Isometry3d (anyPose ())})
  {
    const std::vector<OrientedPoint> points = moved (noisy (observedPlate (0.0, 0.02)), pose);
    const ProfiledShape plate (points);
    EXPECT_NEAR (plate.wallThickness (), 0.04 * rim_radius, 0.0005);
    EXPECT_GT (discAt (-plate.wallThickness (), plate, points, pose), 100);
  }
}

// Like that of a dinner plate: no part of it faces sideways.
TEST (Dish, ARimMayBeLevel)
{
  const double floor = 0.004, depth = 0.015, end = 0.14;
  std::vector<OrientedPoint> points = observedPlate (floor, depth);
  for (double radius = rim_radius; radius < end; radius += 0.002)
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.002 / radius)
      points.push_back (
          pointAt ({radius * std::cos (angle), radius * std::sin (angle), floor + depth}, Eigen::Vector3d::UnitZ ()));
  points = noisy (points);
  const ProfiledShape plate (points, ground);
  EXPECT_NEAR (plate.wallThickness (), floor, 0.0005);
  std::ptrdiff_t under = 0;
  for (const OrientedPoint& p : plate.hiddenSide (points, 0.002))
    if (std::abs (p.position.head<2> ().norm () - 0.12f) < 0.005f && p.normal.z () < -0.9f)
    {
      ++under;
      EXPECT_NEAR (p.position.z (), depth, 0.001);
    }
  EXPECT_GT (under, 100);
}

TEST (Dish, ComesOutThin)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  const double wall = 0.006;
  scene.add (1, [=] (const Eigen::Vector3d& p) { // a cap of a ball
    const double out = (p - Eigen::Vector3d (0.0, 0.0, 0.08)).norm () - 0.08;
    return std::max ({out, -out - wall, p.z () - 0.03});
  });
  CoSectionOptions options = optionsFor (0.0);
  const ObjectResult dish = completeFrom (scene, {0}, options);
  options.use_symmetric_extent = false;
  const ObjectResult anything = completeFrom (scene, {0}, options);
  ASSERT_EQ (dish.error + anything.error, "");
  EXPECT_TRUE (computeTopology (dish.mesh).closed_manifold);
  const double as_dish_m = meanError (dish.mesh, scene.shape (1));
  EXPECT_LT (as_dish_m, 0.001);
  EXPECT_GT (meanError (anything.mesh, scene.shape (1)), 5.0 * as_dish_m);
}

TEST (Vessel, UpsideDownItIsOpenBelow)
{
  const Eigen::Isometry3d over (Eigen::Translation3d (0.0, 0.0, 0.09) *
                                Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitX ()));
  for (const double inner_end : {0.087, 0.0899}) // without and with the end of the inside
  {
    const std::vector<OrientedPoint> vertical = wholeCup (inner_end);
    const std::vector<OrientedPoint> points = moved (vertical, over);
    for (const ProfiledShape& extent : {ProfiledShape (points), ProfiledShape (points, ground)})
    {
      EXPECT_NEAR (extent.wallThickness (), 0.004, 0.0003);
      EXPECT_EQ (discAt (0.0, extent, points), 0);   // the mouth
      EXPECT_GT (discAt (0.09, extent, points), 50); // the bottom
      EXPECT_GT (extent.depthInCavity ({0.0, 0.0, 0.02}), 0.03);
    }
    EXPECT_GT (discAt (0.0, ProfiledShape (vertical, ground), vertical), 50);
  }
}

TEST (Vessel, ATubeIsOneHoweverFarBelowItThePlaneIs)
{
  const Profile inside = [] (double /*height*/) { return std::pair (0.036, 0.0); };
  std::vector<OrientedPoint> tube = observedRound (can, 0.0, 0.09, {0.0, -0.8, 0.6});
  const std::vector<OrientedPoint> inner = observedRound (inside, 0.0, 0.09, {0.0, -0.8, 0.6}, -1.0);
  tube.insert (tube.end (), inner.begin (), inner.end ());
  for (const double below : {0.0, 0.0019, 0.0021, 0.004})
    EXPECT_EQ (ProfiledShape (tube, {0.0, 0.0, 1.0, below}).wallThickness (), 0.0) << below;
}

TEST (Vessel, WhatTheTableIsSeenThroughHasNoFloor)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  const Distance beaker = cup (0.05, 0.08, 0.005);
  scene.add (1, [] (const Eigen::Vector3d& p) {
    const double r = p.head<2> ().norm ();
    return std::max ({r - 0.05, 0.045 - r, p.z () - 0.08, -p.z ()});
  });
  scene.add (2, [=] (const Eigen::Vector3d& p) { return beaker (p - Eigen::Vector3d (0.0, 0.3, 0.0)); });
  const Eigen::Isometry3d above = lookAt ({0.05, -0.1, 0.6}, {0.0, 0.15, 0.0});
  const SceneResult result = complete (scene.render (tableCamera (), above), optionsFor (0.0));
  ASSERT_EQ (result.objects.size (), 2u);
  const auto at = [&] (std::size_t object, const Eigen::Vector3d& p) {
    return result.objects[object].signed_distance->sample (p).value_or (1.0f);
  };
  EXPECT_GT (at (0, {0.0, 0.0, 0.003}), 0.0f);
  EXPECT_LT (at (1, {0.0, 0.3, 0.002}), 0.0f);
  EXPECT_GT (at (1, {0.0, 0.3, 0.02}), 0.0f);
}

TEST (Vessel, PointsWithoutANormalSayNothing)
{
  std::vector<OrientedPoint> points = wholeCup (0.0899);
  points[points.size () / 2].normal.setConstant (std::numeric_limits<float>::quiet_NaN ());
  points.front ().position.setConstant (std::numeric_limits<float>::quiet_NaN ());
  const ProfiledShape extent (points, ground);
  EXPECT_NEAR (extent.wallThickness (), 0.004, 0.0003);
  EXPECT_FALSE (extent.hiddenSide (points, 0.0).empty ()); // and ends
}

// Walls of a cone have the same thickness whatever their slope.
TEST (Vessel, SlopesDoNotMakeWallsThicker)
{
  for (const double slope : {0.5, 1.0, 2.0})
  {
    const double wall = 0.005, shift = wall * std::hypot (1.0, slope); // along the radius
    std::vector<OrientedPoint> points;
    for (const double side : {1.0, -1.0})
    {
      const Profile profile = [&] (double height) {
        return std::pair (0.05 + slope * height - (side < 0.0 ? shift : 0.0), slope);
      };
      for (const double y : {-1.0, 1.0})
      {
        const std::vector<OrientedPoint> seen = observedRound (profile, side > 0.0 ? 0.0 : 0.012, 0.05,
                                                               {0.0, y, side > 0.0 ? -0.5 : 0.8}, side);
        points.insert (points.end (), seen.begin (), seen.end ());
      }
    }
    EXPECT_NEAR (ProfiledShape (points, ground).wallThickness (), wall, 0.0003) << slope;
  }
}
