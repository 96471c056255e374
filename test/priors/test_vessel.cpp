// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// ProfiledShape of round vessels.

#include "completion/scenes/surrounding_views.h"
#include "moved_points.h"
#include "observed_box.h"
#include "round_things.h"

#include "pcl_cosection/priors/fitted_profiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A cup 9 cm high with a wall of 4 mm: its outer side that faces the camera, and its inner side down to some
 * height. */
std::vector<OrientedPoint>
observedCup (double seen_inside_from)
{
  const Eigen::Vector3d view (0.0, -0.8, 0.6);
  std::vector<OrientedPoint> points = observedRound (can, 0.0, 0.09, view);
  const Profile inside = [] (double /*height*/) { return std::pair (0.036, 0.0); };
  const std::vector<OrientedPoint> inner = observedRound (inside, seen_inside_from, 0.09, view, -1.0);
  points.insert (points.end (), inner.begin (), inner.end ());
  return points;
}

} // namespace

class VesselInAnyPose : public testing::TestWithParam<bool>
{};

TEST_P (VesselInAnyPose, HasAFloorAndABottom)
{
  std::vector<OrientedPoint> points = moved (observedCup (0.05), anyPose ());
  if (GetParam ())
    points = noisy (points);
  const double tolerance = GetParam () ? 0.002 : 0.0005;
  const Eigen::Vector3d up = anyPose ().linear () * Eigen::Vector3d::UnitZ ();
  const Eigen::Vector4d plane (up.x (), up.y (), up.z (), -up.dot (anyPose ().translation ()));
  for (const ProfiledShape& extent : {ProfiledShape (points), ProfiledShape (points, plane)})
  {
    ASSERT_NEAR (extent.wallThickness (), 0.004, 0.25 * tolerance + 0.0002);
    const std::vector<OrientedPoint> hidden = extent.hiddenSide (points, 0.001);
    std::vector<OrientedPoint> inner;
    int floor = 0, bottom = 0;
    for (const OrientedPoint& point : hidden)
    {
      const Eigen::Vector3d p = anyPose ().inverse () * point.position.cast<double> ();
      const Eigen::Vector3d n = anyPose ().linear ().transpose () * point.normal.cast<double> ();
      if (p.z () > 0.008 && p.z () < 0.045 && n.head<2> ().dot (p.head<2> ()) < 0.0)
      {
        inner.push_back (point);
        EXPECT_NEAR (p.head<2> ().norm (), 0.036, tolerance);
        EXPECT_EQ (extent.partOf (point), VesselPart::Inner);
      }
      const bool within = p.head<2> ().norm () < 0.03;
      floor += within && n.z () > 0.95 && std::abs (p.z () - 0.004) < tolerance;
      bottom += within && n.z () < -0.95 && std::abs (p.z ()) < tolerance;
      EXPECT_FALSE (within && p.z () > 0.004 + tolerance);
    }
    EXPECT_EQ (sectorsOf (inner, anyPose (), 0.008, 0.045), 36);
    EXPECT_GT (floor, 1000);
    EXPECT_GT (bottom, 1000);
    EXPECT_NEAR (extent.depthInCavity (anyPose () * Eigen::Vector3d (0.01, 0.0, 0.06)), 0.026, tolerance);
    EXPECT_NEAR (extent.depthInCavity (anyPose () * Eigen::Vector3d (0.0, 0.01, 0.01)), 0.006, tolerance);
    EXPECT_EQ (extent.depthInCavity (anyPose () * Eigen::Vector3d (0.0, 0.0, 0.1)), 0.0);
    EXPECT_EQ (extent.depthInCavity (anyPose () * Eigen::Vector3d (0.0, 0.05, 0.05)), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P (Measured, VesselInAnyPose, testing::Bool (),
                          [] (const auto& info) { return info.param ? "Noisy" : "Exact"; });

TEST (Vessel, TubesAndWhatIsSolidAreNoVessels)
{
  const std::vector<OrientedPoint> tube = observedCup (0.0);
  EXPECT_EQ (ProfiledShape (tube, ground).wallThickness (), 0.0);
  EXPECT_EQ (ProfiledShape (tube).wallThickness (), 0.0);
  const std::vector<OrientedPoint> solid = observedRound (can, 0.0, 0.09, {0.0, -0.8, 0.6});
  EXPECT_EQ (ProfiledShape (solid, ground).wallThickness (), 0.0);
  // A ring: its inner and outer sides meet at both ends.
  constexpr double ring_radius = 0.05, radius = 0.015;
  const Eigen::Vector3d view (0.0, -0.8, 0.6);
  std::vector<OrientedPoint> ring;
  for (const double side : {1.0, -1.0})
  {
    const Profile half = [&] (double height) {
      const double across = std::sqrt (std::max (1e-9, radius * radius - height * height));
      return std::pair (ring_radius + side * across, -side * height / across);
    };
    const std::vector<OrientedPoint> seen = observedRound (half, -radius + 0.0005, radius - 0.0005, view, side);
    ring.insert (ring.end (), seen.begin (), seen.end ());
  }
  EXPECT_EQ (ProfiledShape (ring).wallThickness (), 0.0);
  EXPECT_EQ (ProfiledShape (ring, {0.0, 0.0, 1.0, radius}).wallThickness (), 0.0);
}

// One view of a ring: the hole has no floor, and its inner and outer sides are not parallel.
TEST (Vessel, ARingIsNone)
{
  for (const double tube : {0.025, 0.03})
    for (const double rise : {0.6, 0.8, 1.0, 1.2})
    {
      const Eigen::Vector3d view (0.0, -std::cos (rise), std::sin (rise));
      std::vector<OrientedPoint> ring;
      for (double along = 0.0; along < 2.0 * M_PI; along += 0.02)
        for (double across = 0.0; across < 2.0 * M_PI; across += 0.1)
        {
          const Eigen::Vector3d out (std::cos (along), std::sin (along), 0.0);
          const Eigen::Vector3d normal = std::cos (across) * out + std::sin (across) * Eigen::Vector3d::UnitZ ();
          if (normal.dot (view) > 0.2)
            ring.push_back (pointAt (0.1 * out + tube * normal, normal));
        }
      EXPECT_EQ (ProfiledShape (noisy (ring)).wallThickness (), 0.0) << tube << ", " << rise;
    }
}

TEST (Vessel, AFloorThatWasSeenIsWhereItWasSeen)
{
  std::vector<OrientedPoint> points = observedCup (0.012);
  for (double radius = 0.002; radius < 0.036; radius += 0.002)
    for (double angle = 0.0; angle < M_PI; angle += 0.002 / radius)
      points.push_back (pointAt ({radius * std::cos (angle), radius * std::sin (angle), 0.012}, {0.0, 0.0, 1.0}));
  const ProfiledShape extent (points, ground);
  EXPECT_NEAR (extent.wallThickness (), 0.004, 0.0005);
  EXPECT_NEAR (extent.depthInCavity ({0.0, 0.0, 0.022}), 0.01, 0.0005);
}

// A wall of 4 mm, thinner than the voxels that the points' spacing supports.
TEST (Vessel, ThinWallsComeOutAsThickAsTheyAre)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, cup (0.045, 0.09, 0.004));
  const double truth_m3 = computeMassProperties (extractIsoSurface (sampleField (scene.shape (1), 0.15, 0.001)))
                              .volume_m3;
  CoSectionOptions options = optionsFor (0.0);
  const ObjectResult vessel = completeFrom (scene, {0}, options);
  options.use_symmetric_extent = false;
  const ObjectResult anything = completeFrom (scene, {0}, options);
  ASSERT_EQ (vessel.error + anything.error, "");
  EXPECT_TRUE (computeTopology (vessel.mesh).closed_manifold);
  EXPECT_LT (vessel.signed_distance->grid.voxel_size_m, 0.8 * anything.signed_distance->grid.voxel_size_m);
  EXPECT_NEAR (computeMassProperties (vessel.mesh).volume_m3 / truth_m3, 1.0, 0.15);
  EXPECT_LT (meanError (vessel.mesh, scene.shape (1)), 0.001);
  EXPECT_GT (meanError (anything.mesh, scene.shape (1)), 0.002);
  options.use_symmetric_extent = true;
  options.max_memory_bytes = 70 * vessel.signed_distance->grid.size (); // thick walls rather than nothing
  const ObjectResult in_little_memory = completeFrom (scene, {0}, options);
  ASSERT_EQ (in_little_memory.error, "");
  EXPECT_GT (in_little_memory.signed_distance->grid.voxel_size_m, vessel.signed_distance->grid.voxel_size_m);
  options.voxel_size_m = 0.005;
  EXPECT_EQ (completeFrom (scene, {0}, options).signed_distance->grid.voxel_size_m, 0.005);
}

/** \brief Profiles are not exact: ground that was seen beside a vessel may lie within its profile. Only what was seen
 * through the opening shows that there is no floor. */
TEST (Vessel, GroundThatWasSeenBesideItOpensNoFloor)
{
  const std::vector<OrientedPoint> points = observedCup (0.05);
  std::vector<OrientedPoint> seen_ground; // a ring within the wall's inner side
  for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.1)
    seen_ground.push_back (pointAt ({0.03 * std::cos (angle), 0.03 * std::sin (angle), 0.0}, {0.0, 0.0, 1.0}));
  AnalyticScene table;
  table.add (0, halfSpace (ground));
  const auto viewFrom = [&] (const Eigen::Vector3d& sensor, bool hides_it) {
    AnalyticScene scene = table;
    if (hides_it)
      scene.add (1, placed (box ({0.05, 0.05, 0.02}), Eigen::Vector3d (0.0, 0.0, 0.02)));
    return scene.render (smallCamera (), lookAt (sensor, {0.0, 0.0, 0.04})).view;
  };
  const auto hasFloor = [&] (const std::vector<DepthView>& views) {
    Observation object;
    object.all_points = &points;
    object.voxel_size_m = 0.002;
    for (const DepthView& view : views)
      object.views.emplace_back (&view, view.T_world_sensor);
    object.fits = std::make_shared<ShapeFits> ();
    const ObjectSetting setting{false, seen_ground, Eigen::Isometry3d::Identity ()};
    const std::vector<OrientedPoint> all = shapeOf (object, setting, ground).hiddenSide (points, 0.001);
    return std::any_of (all.begin (), all.end (), [] (const OrientedPoint& p) {
      return p.normal.z () > 0.95f && p.position.head<2> ().norm () < 0.02f && p.position.z () < 0.01f;
    });
  };
  const Eigen::Vector3d beside (0.0, -0.6, 0.4), above (0.0, -0.05, 0.8);
  EXPECT_TRUE (hasFloor ({viewFrom (beside, false)}));
  EXPECT_FALSE (hasFloor ({viewFrom (above, false)}));
  EXPECT_TRUE (hasFloor ({viewFrom (beside, false), viewFrom (above, true)})) << "from above it was hidden";
}
