// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

using namespace pcl::cosection;

namespace {

std::vector<double>
shuffled (std::size_t count)
{
  std::vector<double> values (count);
  std::iota (values.begin (), values.end (), 0.0);
  std::shuffle (values.begin (), values.end (), std::mt19937 (1));
  return values;
}

std::vector<Eigen::Vector2d>
randomPoints (int count)
{
  std::mt19937 random (2);
  std::uniform_real_distribution<double> uniform (-1.0, 1.0);
  std::vector<Eigen::Vector2d> points;
  for (int n = 0; n < count; ++n)
    points.emplace_back (uniform (random), uniform (random));
  return points;
}

} // namespace

TEST (Quantile, IsTheSortedValueOfThatRank)
{
  for (const std::size_t count : {1, 2, 7, 100})
  {
    std::vector<double> values = shuffled (count);
    for (const double share : {0.0, 0.1, 0.5, 0.99, 1.0})
      EXPECT_EQ (std::floor (share * static_cast<double> (count - 1)), quantile (values, share)) << count;
    EXPECT_EQ (static_cast<double> (count / 2), upperMedian (values));
  }
}

TEST (Quantile, TrimmedEndsLeaveOutTheSameNumberOnBothSides)
{
  std::vector<double> values = shuffled (50);
  EXPECT_EQ (2.0, trimmedMin (values, 0.05));
  EXPECT_EQ (47.0, trimmedMax (values, 0.05));
  EXPECT_EQ (0.0, trimmedMin (values, 0.0));
  EXPECT_EQ (49.0, trimmedMax (values, 0.0));
}

TEST (Quantile, SigmaOfNormallyDistributedSizesIsTheirStandardDeviation)
{
  std::mt19937 random (3);
  std::normal_distribution<double> normal (0.0, 0.5);
  std::vector<double> sizes (20000);
  std::generate (sizes.begin (), sizes.end (), [&] { return std::abs (normal (random)); });
  EXPECT_NEAR (0.5, sigmaOfSizes (sizes), 0.01);
}

TEST (TrimmedBox, IgnoresAShareOfOutliers)
{
  std::vector<Eigen::Vector3f> points;
  for (int n = 0; n < 100; ++n)
    points.emplace_back (n, 2 * n, -n);
  points[17] = Eigen::Vector3f (1e6f, 1e6f, 1e6f);
  for (const int threads : {1, 3})
  {
    const auto box = trimmedBox<double> (
        points, 0.02, [] (const Eigen::Vector3f& p) { return p; }, threads);
    EXPECT_TRUE (box.min ().isApprox (Eigen::Vector3d (2.0, 4.0, -97.0)));
    EXPECT_TRUE (box.max ().isApprox (Eigen::Vector3d (98.0, 196.0, -1.0)));
  }
}

TEST (ConvexHull, ContainsAllPointsAndTurnsLeftEverywhere)
{
  const std::vector<Eigen::Vector2d> points = randomPoints (200);
  const std::vector<Eigen::Vector2d> hull = convexHull (points);
  ASSERT_GE (hull.size (), 3u);
  for (std::size_t n = 0; n < hull.size (); ++n)
  {
    const Eigen::Vector2d& next = hull[(n + 1) % hull.size ()];
    EXPECT_GT (cross<double> (next - hull[n], hull[(n + 2) % hull.size ()] - next), 0.0);
  }
  for (const Eigen::Vector2d& p : points)
    EXPECT_TRUE (isInside (hull, p) || std::find (hull.begin (), hull.end (), p) != hull.end ());
  EXPECT_FALSE (isInside<double> (hull, {2.0, 0.0}));
  EXPECT_FALSE (isInside<double> ({}, {0.0, 0.0}));
}

TEST (Sectors, DivideTheTurnAroundAnAxisEqually)
{
  const Eigen::Vector3d axis = Eigen::Vector3d (1.0, 2.0, 3.0).normalized ();
  const Sectors sectors (axis, 8);
  std::vector<int> counts (8, 0);
  const Eigen::Vector3d start = axis.unitOrthogonal ();
  for (int n = 0; n < 800; ++n)
  {
    const Eigen::Vector3d q = Eigen::AngleAxisd (2.0 * M_PI * (n + 0.5) / 800, axis) * start;
    ++counts.at (sectors.of (0.3 * q + 5.0 * axis));
  }
  EXPECT_EQ (std::vector<int> (8, 100), counts);
}

TEST (Sectors, TheLastOneEndsWhereTheFirstBegins)
{
  EXPECT_EQ (7u, sectorOf (-1.0, 0.0, 8)); // atan2 is pi: a full turn
  EXPECT_EQ (0u, sectorOf (-1.0, -0.0, 8));
}
