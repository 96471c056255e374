// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// How convex parts touch each other, and the ground.

#include "physical_scenes.h"

#include "pcl_cosection/physics/part_contacts.h"
#include "pcl_cosection/physics/resting.h"

#include <gtest/gtest.h>

#include <random>

namespace pcl::cosection::test {
namespace {

using Turn = Eigen::AngleAxisd;

/** \brief The box of all |x| <= half, moved. */
std::vector<Eigen::Vector3d>
cornersOfBox (const Eigen::Vector3d& half, const Eigen::Isometry3d& T)
{
  std::vector<Eigen::Vector3d> corners;
  for (int n = 0; n < 8; ++n)
    corners.push_back (T * half.cwiseProduct (Eigen::Vector3d ((n & 1) * 2 - 1, (n & 2) - 1, (n & 4) / 2 - 1)));
  return corners;
}

ConvexHull
hullOfBox (const Eigen::Vector3d& half, const Eigen::Isometry3d& T)
{
  return convexHullOf (cornersOfBox (half, T));
}

Eigen::Isometry3d
shifted (const Eigen::Vector3d& by)
{
  return Eigen::Isometry3d (Eigen::Translation3d (by));
}

const std::vector<Eigen::Isometry3d>&
frames ()
{
  static const std::vector<Eigen::Isometry3d> list = {
      Eigen::Isometry3d::Identity (),
      Eigen::Translation3d (0.1, 0.2, -0.3) * Turn (0.6, Eigen::Vector3d (1.0, -2.0, 0.5).normalized ()),
      Eigen::Translation3d (-0.4, 0.1, 0.2) * Turn (2.3, Eigen::Vector3d (-0.2, 0.3, 0.9).normalized ())};
  return list;
}

/** \brief The least overlap along many directions: no less than the true depth. */
double
depthAlongMany (const ConvexHull& first, const ConvexHull& second)
{
  std::mt19937 generator (11);
  std::normal_distribution<double> number;
  double depth = std::numeric_limits<double>::infinity ();
  for (int n = 0; n < 20000; ++n)
  {
    const Eigen::Vector3d direction = Eigen::Vector3d (number (generator), number (generator), number (generator))
                                          .normalized ();
    double high = -std::numeric_limits<double>::infinity (), low = -high;
    for (const Eigen::Vector3d& corner : first.corners)
      high = std::max (high, direction.dot (corner));
    for (const Eigen::Vector3d& corner : second.corners)
      low = std::min (low, direction.dot (corner));
    depth = std::min (depth, high - low);
  }
  return depth;
}

TEST (PartContacts, FacesOverlapByTheirDepth)
{
  const Eigen::Vector3d half (0.05, 0.04, 0.03);
  for (const Eigen::Isometry3d& T : frames ())
    for (const double depth : {0.01, 0.0001, 0.0, -0.0001, -0.01})
    {
      const ConvexHull first = hullOfBox (half, T);
      const ConvexHull second = hullOfBox (half, T * shifted ({0.1 - depth, 0.01, -0.02}));
      const Separation found = separationOf (first, second);
      EXPECT_NEAR (found.depth_m, depth, 1e-9);
      EXPECT_NEAR (found.normal.dot (T.linear ().col (0)), 1.0, 1e-6);
      EXPECT_NEAR (found.offset, found.normal.dot (T * Eigen::Vector3d (0.05 - 0.5 * depth, 0.0, 0.0)), 1e-6);
      const Separation back = separationOf (second, first);
      EXPECT_NEAR (back.depth_m, depth, 1e-9);
      EXPECT_NEAR (back.normal.dot (found.normal), -1.0, 1e-6);
    }
}

TEST (PartContacts, CrossedEdgesOverlapByTheirDepth)
{
  const Eigen::Vector3d half (0.05, 0.05, 0.05);
  const double edge = 0.05 * std::sqrt (2.0); // from the middle of a box
  for (const Eigen::Isometry3d& T : frames ())
    for (const double depth : {0.01, 0.002, -0.002, -0.01})
    {
      const ConvexHull lower = hullOfBox (half, T * Turn (M_PI_4, Eigen::Vector3d::UnitX ()));
      const ConvexHull upper = hullOfBox (half, T * shifted ({0.003, -0.002, 2.0 * edge - depth}) *
                                                    Turn (M_PI_4, Eigen::Vector3d::UnitY ()));
      const Separation found = separationOf (lower, upper);
      EXPECT_GE (found.depth_m, depth - 1e-9);
      EXPECT_NEAR (found.depth_m, depth, 1e-6);
      EXPECT_NEAR (found.normal.dot (T.linear ().col (2)), 1.0, 1e-3);
    }
}

TEST (PartContacts, NoManyDirectionsFindALessOverlap)
{
  std::mt19937 generator (4);
  std::uniform_real_distribution<double> number (-1.0, 1.0);
  double most = 0.0;
  for (int n = 0; n < 100; ++n)
  {
    const auto some = [&] { return Eigen::Vector3d (number (generator), number (generator), number (generator)); };
    std::vector<Eigen::Vector3d> a, b;
    const Eigen::Vector3d away = 1.2 * some ();
    for (int k = 0; k < 30; ++k)
    {
      a.push_back (some ().normalized ());
      b.push_back (some ().normalized () + away);
    }
    const ConvexHull first = convexHullOf (a), second = convexHullOf (b);
    const Separation found = separationOf (first, second);
    double high = -std::numeric_limits<double>::infinity (), low = -high;
    for (const Eigen::Vector3d& corner : first.corners)
      high = std::max (high, found.normal.dot (corner));
    for (const Eigen::Vector3d& corner : second.corners)
      low = std::min (low, found.normal.dot (corner));
    EXPECT_NEAR (found.normal.norm (), 1.0, 1e-9);
    EXPECT_NEAR (found.depth_m, high - low, 1e-9);
    EXPECT_NEAR (found.offset, 0.5 * (high + low), 1e-9);
    if (found.depth_m > 0.0)
      most = std::max (most, found.depth_m - depthAlongMany (first, second));
  }
  EXPECT_LT (most, 0.01);
}

TEST (PartContacts, OverlappingPartsAreCutAtThePlaneBetweenThem)
{
  for (const Eigen::Isometry3d& T : frames ())
  {
    const ConvexHull first = hullOfBox ({0.05, 0.05, 0.05}, T);
    const ConvexHull second = hullOfBox ({0.05, 0.05, 0.05}, T * shifted ({0.09, 0.03, 0.0}));
    const Separation found = separationOf (first, second);
    Eigen::Vector4d plane;
    plane << found.normal, -found.offset;
    const ConvexHull rest_of_first = cutBehind (first, plane), rest_of_second = cutBehind (second, -plane);
    EXPECT_LE (separationOf (rest_of_first, rest_of_second).depth_m, 1e-9);
    EXPECT_NEAR (rest_of_first.volume_m3, 0.095 * 0.1 * 0.1, 1e-9);
    EXPECT_NEAR (rest_of_second.volume_m3, 0.095 * 0.1 * 0.1, 1e-9);
  }
  EXPECT_TRUE (cutBehind (hullOfBox ({1, 1, 1}, frames ()[0]), {0, 0, 1, 2}).empty ());
  EXPECT_NEAR (cutBehind (hullOfBox ({1, 1, 1}, frames ()[0]), {0, 0, 1, -2}).volume_m3, 8.0, 1e-12);
}

// --- The ground ---

Eigen::Vector4d
movedPlane (const Eigen::Isometry3d& T)
{
  const Eigen::Vector3d normal = T.linear ().col (2);
  return {normal.x (), normal.y (), normal.z (), -normal.dot (T.translation ())};
}

TEST (Resting, WhatIsNearThePlaneIsPutOnIt)
{
  for (const Eigen::Isometry3d& T : frames ())
  {
    const Eigen::Vector4d plane = movedPlane (T);
    const TriangleMesh ball = movedMesh (withoutNormals (sphereMesh (0.05, 20)), T * shifted ({0.02, 0.01, 0.049}));
    EXPECT_NEAR (lowestOver (plane, ball), -0.001, 1e-6);
    const TriangleMesh flat = flattenedOn (plane, ball, 0.004);
    ASSERT_EQ (flat.triangles, ball.triangles);
    int on_it = 0;
    for (std::size_t n = 0; n < ball.vertices.size (); ++n)
    {
      const Eigen::Vector3d before = T.inverse () * ball.vertices[n].cast<double> ();
      const Eigen::Vector3d after = T.inverse () * flat.vertices[n].cast<double> ();
      const bool is_near = before.z () < 0.004;
      on_it += is_near ? 1 : 0;
      EXPECT_NEAR (after.z (), is_near ? 0.0 : before.z (), 1e-6);
      EXPECT_NEAR ((after - before).head<2> ().norm (), 0.0, 1e-6);
    }
    EXPECT_GT (on_it, 20);
  }
}

TEST (Resting, ABoxStandsOnItsCorners)
{
  for (const Eigen::Isometry3d& T : frames ())
  {
    const Eigen::Vector3d centre = T * Eigen::Vector3d (0.02, 0.0, 0.03);
    const Stance stance = stanceOf (cornersOfBox ({0.05, 0.04, 0.03}, T * shifted ({0.0, 0.0, 0.03})), movedPlane (T),
                                    centre, 1e-5);
    EXPECT_TRUE (stance.stands);
    EXPECT_EQ (stance.shift_m, 0.0);
    EXPECT_EQ (stance.centre, centre);
    ASSERT_EQ (stance.feet.size (), 4u);
    for (const Eigen::Vector3d& foot : stance.feet)
      EXPECT_NEAR ((T.inverse () * foot).cwiseAbs ().x (), 0.05, 1e-9);
  }
}

TEST (Resting, ACentreBesideTheFeetIsMovedOverThem)
{
  for (const Eigen::Isometry3d& T : frames ())
  {
    // A small block that carries a large one: the middle of it all may be beside the small one.
    std::vector<Eigen::Vector3d> points = cornersOfBox ({0.02, 0.02, 0.02}, T * shifted ({0.0, 0.0, 0.02}));
    const std::vector<Eigen::Vector3d> upper = cornersOfBox ({0.1, 0.04, 0.02}, T * shifted ({0.06, 0.0, 0.06}));
    points.insert (points.end (), upper.begin (), upper.end ());
    const Eigen::Vector3d centre = T * Eigen::Vector3d (0.05, 0.0, 0.055);
    const Stance stance = stanceOf (points, movedPlane (T), centre, 1e-5);
    ASSERT_TRUE (stance.stands);
    const Eigen::Vector3d found = T.inverse () * stance.centre;
    EXPECT_LT (found.x (), 0.02);
    EXPECT_GT (found.x (), 0.015); // not much farther than is needed
    EXPECT_NEAR (found.y (), 0.0, 1e-9);
    EXPECT_NEAR (found.z (), 0.055, 1e-9);
    EXPECT_NEAR (stance.shift_m, 0.05 - found.x (), 1e-9);

    // Not to where the body is not.
    const Eigen::Vector3d above = T * Eigen::Vector3d (0.05, 0.0, 0.2);
    const Stance fallen = stanceOf (points, movedPlane (T), above, 1e-5);
    EXPECT_FALSE (fallen.stands);
    EXPECT_EQ (fallen.shift_m, 0.0);
    EXPECT_EQ (fallen.centre, above);
  }
}

TEST (Resting, AtMostEightFeetHoldMostOfTheArea)
{
  std::vector<Eigen::Vector3d> points;
  constexpr int corners = 100;
  for (int n = 0; n < corners; ++n)
    for (const double z : {0.0, 0.1})
      points.emplace_back (std::cos (2.0 * M_PI * n / corners), 0.5 * std::sin (2.0 * M_PI * n / corners), z);
  const Stance stance = stanceOf (points, floor_plane, {0.0, 0.0, 0.05}, 1e-5);
  EXPECT_TRUE (stance.stands);
  ASSERT_EQ (stance.feet.size (), 8u);
  double area = 0.0;
  for (std::size_t n = 0; n < 8; ++n)
  {
    const Eigen::Vector3d &a = stance.feet[n], &b = stance.feet[(n + 1) % 8];
    EXPECT_NEAR (a.z (), 0.0, 1e-9);
    area += 0.5 * (a.x () * b.y () - a.y () * b.x ());
  }
  EXPECT_GT (area, 0.85 * 0.5 * M_PI);
}

TEST (Resting, OnAnEdgeOrInTheAirItDoesNotStand)
{
  const Eigen::Isometry3d on_edge = shifted ({0.0, 0.0, 0.05 * std::sqrt (2.0)}) *
                                    Turn (M_PI_4, Eigen::Vector3d::UnitX ());
  for (const Eigen::Isometry3d& T : {on_edge, shifted ({0.0, 0.0, 0.06})})
  {
    const Stance stance = stanceOf (cornersOfBox ({0.05, 0.05, 0.05}, T), floor_plane, T.translation (), 1e-5);
    EXPECT_FALSE (stance.stands);
    EXPECT_TRUE (stance.feet.empty ());
    EXPECT_EQ (stance.centre, T.translation ());
  }
}

} // namespace
} // namespace pcl::cosection::test
