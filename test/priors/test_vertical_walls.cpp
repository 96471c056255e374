// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Expected vertical walls of standing things, few of which were seen.

#include "moved_points.h"
#include "observed_box.h"

#include "pcl_cosection/priors/shape/symmetric_extent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector3d block_half_size (0.08, 0.05, 0.06);
const Eigen::Vector3d block_view (-1.0, -1.0, 1.0);
const Eigen::Vector4d under_block (0.0, 0.0, 1.0, block_half_size.z ());
constexpr double wall_step_m = 0.004;
constexpr double wall_tolerance_m = 0.006;

std::vector<OrientedPoint>
joined (const std::vector<WallColumn>& walls)
{
  std::vector<OrientedPoint> all;
  for (const WallColumn& wall : walls)
    all.insert (all.end (), wall.begin (), wall.end ());
  return all;
}

/** \brief Whether there is a point near \a p with about the normal \a normal. */
bool
hasWallAt (const std::vector<OrientedPoint>& walls, const Eigen::Vector3d& p, const Eigen::Vector3d& normal)
{
  return std::any_of (walls.begin (), walls.end (), [&] (const OrientedPoint& wall) {
    return (wall.position.cast<double> () - p).norm () < 1.5 * wall_step_m &&
           wall.normal.cast<double> ().dot (normal) > 0.95;
  });
}

/** \brief The top of a wedge of cheese, x, y >= 0 and x / 0.16 + y / 0.1 <= 1, 0.12 high, and the wall that faces -y.
 */
std::vector<OrientedPoint>
observedWedge ()
{
  std::vector<OrientedPoint> points;
  for (double x = 0.0; x <= 0.16; x += 0.002)
  {
    for (double y = 0.0; x / 0.16 + y / 0.1 <= 1.0; y += 0.002)
      points.push_back ({Eigen::Vector3d (x, y, 0.12).cast<float> (), Eigen::Vector3f::UnitZ ()});
    for (double z = 0.0; z <= 0.12; z += 0.002)
      points.push_back ({Eigen::Vector3d (x, 0.0, z).cast<float> (), -Eigen::Vector3f::UnitY ()});
  }
  return points;
}

std::vector<OrientedPoint>
without (std::vector<OrientedPoint> points, const std::function<bool (const Eigen::Vector3f&)>& hidden)
{
  points.erase (
      std::remove_if (points.begin (), points.end (), [&] (const OrientedPoint& p) { return hidden (p.position); }),
      points.end ());
  return points;
}

/** \brief Expect walls on all four sides, from the plane to the top, and nowhere else. */
void
expectWallsOfBox (const std::vector<OrientedPoint>& walls)
{
  for (const double sense : {-1.0, 1.0})
    for (const double height : {-0.9, 0.0, 0.9})
      for (const double along : {-0.7, 0.0, 0.7})
      {
        EXPECT_TRUE (hasWallAt (
            walls, {sense * block_half_size.x (), along * block_half_size.y (), height * block_half_size.z ()},
            sense * Eigen::Vector3d::UnitX ()))
            << "x " << sense << ", along " << along << ", height " << height;
        EXPECT_TRUE (hasWallAt (
            walls, {along * block_half_size.x (), sense * block_half_size.y (), height * block_half_size.z ()},
            sense * Eigen::Vector3d::UnitY ()))
            << "y " << sense << ", along " << along << ", height " << height;
      }
  for (const OrientedPoint& wall : walls)
  {
    const Eigen::Array3d off = wall.position.cast<double> ().array ().abs () - block_half_size.array ();
    EXPECT_LT (off.maxCoeff (), wall_tolerance_m) << wall.position.transpose ();
    EXPECT_GT (off.head<2> ().maxCoeff (), -wall_tolerance_m) << wall.position.transpose ();
  }
}

} // namespace

TEST (VerticalWalls, AreAllAroundABox)
{
  const SymmetricExtent extent (observedBox (block_half_size, block_view), under_block);
  expectWallsOfBox (joined (extent.verticalWalls (wall_step_m, true)));
  expectWallsOfBox (joined (extent.verticalWalls (wall_step_m, false)));
}

TEST (VerticalWalls, GoDownToThePlaneWhereTheyWereNotSeen)
{
  const auto lower_half = [] (const Eigen::Vector3f& p) { return p.z () < 0.0f; };
  const SymmetricExtent extent (without (observedBox (block_half_size, block_view), lower_half), under_block);
  expectWallsOfBox (joined (extent.verticalWalls (wall_step_m, false)));
}

TEST (VerticalWalls, GoOnUnderTheTopWhereTheyWereNotSeen)
{
  const auto left_part = [] (const Eigen::Vector3f& p) {
    return p.x () < 0.03f && p.z () < static_cast<float> (block_half_size.z ()) - 0.001f;
  };
  const SymmetricExtent extent (without (observedBox (block_half_size, block_view), left_part), under_block);
  expectWallsOfBox (joined (extent.verticalWalls (wall_step_m, false)));
}

/** \brief The copy of a wedge by a half turn would be the other half of a box. */
TEST (VerticalWalls, OfAWedgeAreThoseOfItsTopOrOfItsTopAndACopy)
{
  const SymmetricExtent extent (observedWedge (), {0.0, 0.0, 1.0, 0.0});
  const Eigen::Vector3d slope (0.08, 0.05, 0.04), far_side (0.12, 0.093, 0.1); // its tip is an outlier
  const Eigen::Vector3d out = Eigen::Vector3d (1.0 / 0.16, 1.0 / 0.1, 0.0).normalized ();
  const std::vector<OrientedPoint> own = joined (extent.verticalWalls (wall_step_m, false));
  EXPECT_TRUE (hasWallAt (own, slope, out));
  EXPECT_FALSE (hasWallAt (own, far_side, Eigen::Vector3d::UnitY ()));
  const std::vector<OrientedPoint> with_copy = joined (extent.verticalWalls (wall_step_m, true));
  EXPECT_FALSE (hasWallAt (with_copy, slope, out));
  EXPECT_TRUE (hasWallAt (with_copy, far_side, Eigen::Vector3d::UnitY ()));
}

/** \brief Two levels: the walls of the upper one end on the lower one. */
TEST (VerticalWalls, BelowEdgesEndOnALowerTop)
{
  std::vector<OrientedPoint> points;
  for (double x = 0.0; x <= 0.16; x += 0.002)
  {
    const double height = x < 0.08 ? 0.12 : 0.06;
    for (double y = 0.0; y <= 0.1; y += 0.002)
      points.push_back ({Eigen::Vector3d (x, y, height).cast<float> (), Eigen::Vector3f::UnitZ ()});
    for (double z = 0.0; z <= height; z += 0.002)
      points.push_back ({Eigen::Vector3d (x, 0.0, z).cast<float> (), -Eigen::Vector3f::UnitY ()});
  }
  const std::vector<OrientedPoint> walls = joined (
      SymmetricExtent (points, {0.0, 0.0, 1.0, 0.0}).wallsBelowEdges (wall_step_m));
  for (const double y : {0.03, 0.05, 0.07})
  {
    EXPECT_TRUE (hasWallAt (walls, {0.08, y, 0.09}, Eigen::Vector3d::UnitX ()));
    EXPECT_FALSE (hasWallAt (walls, {0.08, y, 0.03}, Eigen::Vector3d::UnitX ()));
    EXPECT_TRUE (hasWallAt (walls, {0.16, y, 0.03}, Eigen::Vector3d::UnitX ()));
    EXPECT_TRUE (hasWallAt (walls, {0.0, y, 0.03}, -Eigen::Vector3d::UnitX ()));
  }
  for (const OrientedPoint& wall : walls)
    EXPECT_FALSE (wall.position.x () > 0.02f && wall.position.x () < 0.065f && wall.position.y () > 0.02f &&
                  wall.position.y () < 0.08f);
}

TEST (VerticalWalls, BelowEdgesFollowANotch)
{
  std::vector<OrientedPoint> points; // an L, of which the notch is at the back
  for (double x = 0.0; x <= 0.16; x += 0.002)
  {
    for (double y = 0.0; y <= (x < 0.06 ? 0.16 : 0.06); y += 0.002)
      points.push_back ({Eigen::Vector3d (x, y, 0.08).cast<float> (), Eigen::Vector3f::UnitZ ()});
    for (double z = 0.0; z <= 0.08; z += 0.002)
      points.push_back ({Eigen::Vector3d (x, 0.0, z).cast<float> (), -Eigen::Vector3f::UnitY ()});
  }
  const SymmetricExtent extent (points, {0.0, 0.0, 1.0, 0.0});
  const std::vector<OrientedPoint> walls = joined (extent.wallsBelowEdges (wall_step_m));
  EXPECT_TRUE (hasWallAt (walls, {0.06, 0.11, 0.04}, Eigen::Vector3d::UnitX ()));
  EXPECT_TRUE (hasWallAt (walls, {0.11, 0.06, 0.04}, Eigen::Vector3d::UnitY ()));
  const Eigen::Vector3d across = Eigen::Vector3d (1.0, 1.0, 0.0).normalized ();
  EXPECT_FALSE (hasWallAt (walls, {0.11, 0.11, 0.04}, across));
  EXPECT_TRUE (hasWallAt (joined (extent.verticalWalls (wall_step_m, false)), {0.107, 0.107, 0.04},
                          across)); // that of the convex outline
}

TEST (VerticalWalls, MoveWithTheObject)
{
  const Eigen::Isometry3d T = Eigen::Translation3d (0.3, -0.2, 0.9) *
                              Eigen::AngleAxisd (0.7, Eigen::Vector3d (1.0, 2.0, -1.0).normalized ());
  const std::vector<OrientedPoint> points = observedBox (block_half_size, block_view);
  Eigen::Vector4d plane;
  plane.head<3> () = T.linear () * under_block.head<3> ();
  plane[3] = under_block[3] - plane.head<3> ().dot (T.translation ());
  std::vector<OrientedPoint> walls = joined (
      SymmetricExtent (moved (points, T), plane).verticalWalls (wall_step_m, true));
  expectWallsOfBox (moved (walls, T.inverse ()));
}

/** \brief Balls, roofs and things that do not stand have no vertical walls. */
TEST (VerticalWalls, AreOnlyOfWhatHasSuchWalls)
{
  EXPECT_TRUE (SymmetricExtent (observedBox (block_half_size, block_view)).verticalWalls (wall_step_m, true).empty ());
  const Eigen::Isometry3d tilt (Eigen::AngleAxisd (0.6, Eigen::Vector3d::UnitX ()));
  EXPECT_TRUE (SymmetricExtent (moved (observedBox (block_half_size, block_view), tilt), {0.0, 0.0, 1.0, 0.1})
                   .verticalWalls (wall_step_m, true)
                   .empty ());
  EXPECT_TRUE (SymmetricExtent ({}, under_block).verticalWalls (wall_step_m, true).empty ());
}

TEST (VerticalWalls, AreTheHiddenSideOfWhatTheyBound)
{
  const std::vector<OrientedPoint> points = observedWedge ();
  const SymmetricExtent extent (points, {0.0, 0.0, 1.0, 0.0});
  EXPECT_FALSE (extent.isPrism ());
  const std::vector<OrientedPoint> walls = joined (extent.verticalWalls (wall_step_m, false));
  const SymmetricExtent prism = extent.boundedBy (walls, true);
  EXPECT_TRUE (prism.isPrism ());
  EXPECT_EQ (prism.hiddenSide (points, 0.01).size (), walls.size ());
  EXPECT_EQ (prism.continuation ().size (), walls.size ());
}

/** \brief The plausible region contains further expected points and their copies. */
TEST (Continuation, WidensThePlausibleRegion)
{
  const auto lower_half = [] (const Eigen::Vector3f& p) { return p.z () < 0.0f; };
  const std::vector<OrientedPoint> points = without (observedBox (block_half_size, block_view), lower_half);
  const SymmetricExtent extent (points, under_block);
  const Eigen::Vector3d corner = Eigen::Vector3d (0.95, 0.95, -0.95).cwiseProduct (block_half_size);
  EXPECT_GT (extent.beyond (corner), 0.01);
  std::vector<OrientedPoint> continuation;
  for (const OrientedPoint& p : observedBox (block_half_size, {-1.0, -1.0, 0.0}))
    if (lower_half (p.position))
      continuation.push_back (p);
  const SymmetricExtent more = extent.continuedBy (continuation);
  EXPECT_LT (more.beyond (corner), 0.003);
  EXPECT_EQ (more.continuation ().size (), 2 * continuation.size ());
  EXPECT_FALSE (more.isPrism ());
}
