// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "moved_points.h"
#include "observed_box.h"

#include "pcl_cosection/priors/shape/symmetric_extent.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector3d half_size (0.08, 0.05, 0.06);
const Eigen::Vector3d corner_view (-1.0, -1.0, 1.0);
const Eigen::Vector4d under_box (0.0, 0.0, 1.0, half_size.z ());

/** \brief Points of a ball that face a distant camera in direction \a view. */
std::vector<OrientedPoint>
observedBall (const Eigen::Vector3d& middle, double radius, const Eigen::Vector3d& view)
{
  std::vector<OrientedPoint> points;
  constexpr double step = 0.04;
  for (double polar = 0.5 * step; polar < M_PI; polar += step)
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += step / std::sin (polar))
    {
      const Eigen::Vector3d n (std::sin (polar) * std::cos (angle), std::sin (polar) * std::sin (angle),
                               std::cos (polar));
      if (n.dot (view) < 0.1)
        continue;
      OrientedPoint point;
      point.position = (middle + radius * n).cast<float> ();
      point.normal = n.cast<float> ();
      points.push_back (point);
    }
  return points;
}

/** \brief Expect that the region ends with the box around the hidden faces (x, y > 0). */
void
expectRegionOfBox (const SymmetricExtent& extent)
{
  for (const int axis : {0, 1})
  {
    Eigen::Vector3d p = Eigen::Vector3d::Zero ();
    p[axis] = half_size[axis];
    EXPECT_NEAR (extent.beyond (p), 0.0, 0.003) << "axis " << axis;
    p[axis] += 0.03;
    EXPECT_NEAR (extent.beyond (p), 0.03, 0.003) << "axis " << axis;
  }
  EXPECT_LE (extent.beyond (half_size.cwiseProduct (Eigen::Vector3d (0.95, 0.95, 0.95))), 0.003);
  EXPECT_LT (extent.beyond (Eigen::Vector3d::Zero ()), -0.04);
}

} // namespace

TEST (SymmetricExtent, BoxOnAPlaneEndsWhereItsHiddenFacesAre)
{
  const SymmetricExtent extent (observedBox (half_size, corner_view), under_box);
  EXPECT_LT (extent.center ().head<2> ().norm (), 0.003);
  expectRegionOfBox (extent);
}

TEST (SymmetricExtent, BoxInTheAirEndsWhereItsHiddenFacesAre)
{
  const SymmetricExtent extent (observedBox (half_size, corner_view));
  EXPECT_LT (extent.center ().norm (), 0.004);
  expectRegionOfBox (extent);
  EXPECT_NEAR (extent.beyond ({0.0, 0.0, -half_size.z () - 0.03}), 0.03, 0.003);
}

TEST (SymmetricExtent, BoxSeenFromTheFrontIsAsDeepAsItsTop)
{
  const SymmetricExtent extent (observedBox (half_size, {0.0, -1.0, 1.0}), under_box);
  EXPECT_NEAR (extent.beyond ({0.0, half_size.y () + 0.02, 0.0}), 0.02, 0.005);
}

TEST (SymmetricExtent, BackOfABottleIsAsFarAsItsFront)
{
  constexpr double radius = 0.04;
  std::vector<OrientedPoint> points;
  for (double angle = M_PI; angle <= 2.0 * M_PI; angle += 0.03)
    for (double z = 0.0; z < 0.2; z += 0.003)
    {
      const Eigen::Vector3d n (std::cos (angle), std::sin (angle), 0.0);
      OrientedPoint point;
      point.position = (radius * n + Eigen::Vector3d (0.5, 0.2, z)).cast<float> ();
      point.normal = n.cast<float> ();
      points.push_back (point);
    }
  const SymmetricExtent extent (points, ground);
  EXPECT_NEAR (extent.center ().x (), 0.5, 0.002);
  EXPECT_NEAR (extent.center ().y (), 0.2, 0.004);
  EXPECT_LE (extent.beyond ({0.5, 0.2 + 0.8 * radius, 0.1}), 0.0);
  EXPECT_NEAR (extent.beyond ({0.5, 0.2 + radius + 0.03, 0.1}), 0.03, 0.008);
}

TEST (SymmetricExtent, BallTouchesWhatItStandsOn)
{
  constexpr double radius = 0.06;
  const Eigen::Vector3d middle (0.1, 0.2, radius);
  const std::vector<OrientedPoint> points = observedBall (middle, radius, Eigen::Vector3d (0.0, -0.8, 0.6));
  const SymmetricExtent standing (points, ground);
  EXPECT_LE (standing.beyond ({0.1, 0.2, 0.005}), 0.0);
  EXPECT_NEAR (standing.beyond ({0.1, 0.2 + radius + 0.03, radius}), 0.03, 0.006);
  EXPECT_LE (standing.beyond (middle + radius * Eigen::Vector3d (1.0, 0.0, -1.0).normalized ()),
             0.006); // below its side
}

TEST (SymmetricExtent, HiddenSideOfABallIsOnTheBall)
{
  constexpr double radius = 0.06;
  const Eigen::Vector3d middle (0.1, 0.2, radius);
  const Eigen::Vector3d view (0.0, -0.8, 0.6);
  const std::vector<OrientedPoint> points = observedBall (middle, radius, view);
  const std::vector<OrientedPoint> hidden = SymmetricExtent (points, ground).hiddenSide (points, 0.004);
  ASSERT_GT (hidden.size (), points.size () / 2);
  for (const OrientedPoint& p : hidden)
  {
    EXPECT_NEAR ((p.position.cast<double> () - middle).norm (), radius, 0.004);
    EXPECT_GT (p.normal.cast<double> ().dot ((p.position.cast<double> () - middle).normalized ()), 0.99);
  }
}

TEST (SymmetricExtent, CavitiesHaveNoCopy)
{
  std::vector<OrientedPoint> points = observedBox (half_size, corner_view);
  const std::size_t on_box = points.size ();
  for (double x = -0.04; x < 0.04; x += 0.004) // the floor of a pit
    for (double y = -0.03; y < 0.03; y += 0.004)
    {
      OrientedPoint point;
      point.position = Eigen::Vector3d (x, y, 0.0).cast<float> ();
      point.normal = Eigen::Vector3f::UnitZ ();
      points.push_back (point);
    }
  ASSERT_GT (points.size (), on_box + 100);
  const std::vector<OrientedPoint> hidden = SymmetricExtent (points, under_box).hiddenSide (points, 0.004);
  EXPECT_FALSE (hidden.empty ());
  for (const OrientedPoint& p : hidden)
    EXPECT_FALSE (std::abs (p.position.z ()) < 1e-3f && p.normal.z () > 0.9f);
}

TEST (SymmetricExtent, MovesWithThePoints)
{
  const Eigen::Isometry3d T = Eigen::Translation3d (0.3, -0.2, 0.7) *
                              Eigen::AngleAxisd (0.8, Eigen::Vector3d (1.0, 2.0, -1.0).normalized ());
  const std::vector<OrientedPoint> points = observedBox (half_size, corner_view);
  const SymmetricExtent still (points, under_box);
  Eigen::Vector4d plane;
  plane << T.linear () * under_box.head<3> (), 0.0;
  plane[3] = under_box[3] - plane.head<3> ().dot (T.translation ());
  const SymmetricExtent elsewhere (moved (points, T), plane);
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d (0.0, 0.08, 0.0), Eigen::Vector3d (0.11, 0.0, 0.0), Eigen::Vector3d (0.0, 0.0, 0.1)})
    EXPECT_NEAR (elsewhere.beyond (T * x), still.beyond (x), 0.004);
}

TEST (SymmetricExtent, ARowIsItsPoints)
{
  const SymmetricExtent extent (observedBox (half_size, corner_view));
  const Eigen::Vector3d first (-0.1, 0.07, 0.01);
  const Eigen::Vector3d step (0.004, 0.001, 0.0);
  std::vector<float> row (50);
  extent.beyond (first, step, static_cast<int> (row.size ()), row.data ());
  for (std::size_t i = 0; i < row.size (); ++i)
    EXPECT_NEAR (row[i], extent.beyond (first + static_cast<double> (i) * step), 1e-6);
}

TEST (SymmetricExtent, NoPointsSayNothing)
{
  EXPECT_EQ (SymmetricExtent (std::vector<OrientedPoint> ()).beyond ({1.0, 2.0, 3.0}), 0.0);
}

TEST (SymmetricExtent, AVerticalLineIsNoWiderThanItIs)
{
  std::vector<OrientedPoint> points = observedBox ({1e-6, 1e-6, 0.1}, {-1.0, 0.0, 0.0});
  for (OrientedPoint& p : points)
    p.position.head<2> ().setZero ();
  EXPECT_NEAR (SymmetricExtent (points, ground).beyond ({0.05, 0.0, 0.05}), 0.05, 0.002);
}
