// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"

#include "pcl_cosection/energy/data/imls_data_term.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

VoxelGrid
testGrid ()
{
  VoxelGrid grid;
  grid.dims = {11, 8, 14};
  grid.voxel_size_m = 0.005;
  grid.origin_m = {0.31, -0.12, 0.77};
  return grid;
}

/** \brief Call f (squared distance in voxels, offset of the voxel from the point in voxels, its index). */
template <typename Function>
void
forEachOffset (const VoxelGrid& grid, const Eigen::Vector3d& point_vox, Function&& f)
{
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        f (Eigen::Vector3d (Eigen::Vector3d (i, j, k) - point_vox), grid.index (i, j, k));
}

/** \brief Points in and around the grid, without any voxel so close to the cutoff that rounding decides. */
std::vector<OrientedPoint>
randomPoints (const VoxelGrid& grid, double sigma_vox, int number)
{
  std::mt19937 generator (11);
  std::uniform_real_distribution<double> uniform (0.0, 1.0);
  std::vector<OrientedPoint> points;
  while (static_cast<int> (points.size ()) < number)
  {
    const double around = 4.0 * sigma_vox;
    Eigen::Vector3d at;
    for (int a = 0; a < 3; ++a)
      at[a] = -around + uniform (generator) * (grid.dims[a] - 1 + 2.0 * around);
    OrientedPoint point;
    point.position = (grid.origin_m + grid.voxel_size_m * at).cast<float> ();
    point.normal = Eigen::Vector3f (uniform (generator) - 0.5, uniform (generator) - 0.5, uniform (generator) - 0.5)
                       .normalized ();
    point.weight = static_cast<float> (uniform (generator));
    bool clear = true;
    forEachOffset (grid, grid.toVoxel (point.position.cast<double> ()), [&] (const Eigen::Vector3d& d, std::size_t) {
      clear &= std::abs (d.norm () - 3.0 * sigma_vox) > 1e-3;
    });
    if (clear)
      points.push_back (point);
  }
  return points;
}

ImlsDataTerm
gathered (const VoxelGrid& grid, const std::vector<OrientedPoint>& points, double sigma_vox = 1.0, int threads = 1)
{
  ImlsDataTerm data;
  data.add (grid, points, sigma_vox, threads);
  return data;
}

/** \brief A point at a voxel's centre. */
OrientedPoint
pointAt (const VoxelGrid& grid, int i, int j, int k)
{
  OrientedPoint point;
  point.position = grid.center (i, j, k).cast<float> ();
  point.normal = Eigen::Vector3f::UnitZ ();
  return point;
}

bool
sameBytes (const std::vector<float>& a, const std::vector<float>& b)
{
  return a.size () == b.size () && std::memcmp (a.data (), b.data (), a.size () * sizeof (float)) == 0;
}

class ImlsDataTermTest : public testing::TestWithParam<double>
{};

} // namespace

TEST_P (ImlsDataTermTest, EqualsTheDoubleLoop)
{
  const VoxelGrid grid = testGrid ();
  const double sigma = GetParam ();
  const std::vector<OrientedPoint> points = randomPoints (grid, sigma, 300);
  const ImlsDataTerm data = gathered (grid, points, sigma);
  std::vector<double> weight (grid.size (), 0.0), target (grid.size (), 0.0), count (grid.size (), 0.0);
  for (const OrientedPoint& point : points)
    forEachOffset (grid, grid.toVoxel (point.position.cast<double> ()), [&] (const Eigen::Vector3d& d, std::size_t n) {
      if (d.norm () > 3.0 * sigma)
        return;
      const double w = point.weight * std::exp (-d.squaredNorm () / (sigma * sigma));
      weight[n] += w;
      target[n] += w * d.dot (point.normal.cast<double> ());
      count[n] += 1.0;
    });
  ASSERT_EQ (data.weight.size (), grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
  {
    ASSERT_EQ (data.count[n], count[n]) << "voxel " << n;
    ASSERT_NEAR (data.weight[n], weight[n], 2e-5 * (weight[n] + 1e-2)) << "voxel " << n;
    ASSERT_NEAR (data.weighted_target[n], target[n], 2e-5 * sigma * (weight[n] + 1e-2)) << "voxel " << n;
  }
}

TEST_P (ImlsDataTermTest, ThreadsDoNotChangeABit)
{
  const VoxelGrid grid = testGrid ();
  const std::vector<OrientedPoint> points = randomPoints (grid, GetParam (), 300);
  const ImlsDataTerm one = gathered (grid, points, GetParam (), 1);
  for (const int threads : {2, 3, 14, 20})
  {
    const ImlsDataTerm many = gathered (grid, points, GetParam (), threads);
    EXPECT_TRUE (sameBytes (one.weight, many.weight)) << threads << " threads";
    EXPECT_TRUE (sameBytes (one.weighted_target, many.weighted_target)) << threads << " threads";
    EXPECT_TRUE (sameBytes (one.count, many.count)) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P (Sigmas, ImlsDataTermTest, testing::Values (0.2, 0.7, 1.0, 2.3, 10.0));

TEST (ImlsDataTermSigns, ArePositiveOutside)
{
  const VoxelGrid grid = testGrid ();
  const ImlsDataTerm data = gathered (grid, {pointAt (grid, 5, 4, 7)});
  EXPECT_NEAR (data.weight[grid.index (5, 4, 7)], 1.0f, 1e-4f);
  EXPECT_NEAR (data.weighted_target[grid.index (5, 4, 8)] / data.weight[grid.index (5, 4, 8)], 1.0f, 1e-3f);
  EXPECT_NEAR (data.weighted_target[grid.index (5, 4, 5)] / data.weight[grid.index (5, 4, 5)], -2.0f, 1e-3f);
}

TEST (ImlsDataTermSums, AddUpOverCalls)
{
  const VoxelGrid grid = testGrid ();
  const std::vector<OrientedPoint> points = randomPoints (grid, 1.0, 100);
  ImlsDataTerm parts;
  parts.add (grid, {points.begin (), points.begin () + 40}, 1.0, 1);
  parts.add (grid, {points.begin () + 40, points.end ()}, 1.0, 1);
  const ImlsDataTerm whole = gathered (grid, points);
  EXPECT_EQ (parts.count, whole.count);
  for (std::size_t n = 0; n < grid.size (); ++n)
    ASSERT_NEAR (parts.weight[n], whole.weight[n], 1e-5f * (whole.weight[n] + 1e-2f));
}

TEST (ImlsDataTermWeighting, MeanDividesByTheCountAndSumDoesNot)
{
  const VoxelGrid grid = testGrid ();
  const std::vector<OrientedPoint> points = randomPoints (grid, 1.0, 200);
  const ImlsDataTerm raw = gathered (grid, points);
  ImlsDataTerm mean = raw;
  mean.finish (Weighting::Mean);
  ImlsDataTerm sum = raw;
  sum.finish (Weighting::Sum);
  EXPECT_TRUE (sameBytes (sum.weight, raw.weight));
  EXPECT_TRUE (sameBytes (sum.weighted_target, raw.weighted_target));
  std::size_t empty = 0;
  for (std::size_t n = 0; n < grid.size (); ++n)
  {
    empty += raw.count[n] == 0.0f;
    const float divisor = std::max (1.0f, raw.count[n]);
    ASSERT_NEAR (mean.weight[n], raw.weight[n] / divisor, 1e-6f);
    ASSERT_NEAR (mean.weighted_target[n], raw.weighted_target[n] / divisor, 1e-6f);
    ASSERT_LE (mean.weight[n], 1.0f);
  }
  EXPECT_GT (empty, 0u) << "no voxel without points was checked";
}

TEST (ImlsDataTermInvalid, PointsAreLeftOut)
{
  const VoxelGrid grid = testGrid ();
  const OrientedPoint good = pointAt (grid, 3, 3, 3);
  std::vector<OrientedPoint> bad (8, pointAt (grid, 4, 3, 3));
  bad[0].position.x () = not_a_number;
  bad[1].position.z () = std::numeric_limits<float>::infinity ();
  bad[2].normal.y () = not_a_number;
  bad[3].weight = 0.0f;
  bad[4].weight = not_a_number;
  bad[5].weight = -1.0f;
  bad[6].position.z () = 1e30f;
  bad[7].position += Eigen::Vector3f (0.0f, 0.0f, 50.0f);
  std::vector<OrientedPoint> all = bad;
  all.push_back (good);
  const ImlsDataTerm with = gathered (grid, all);
  const ImlsDataTerm without = gathered (grid, {good});
  EXPECT_TRUE (sameBytes (with.weight, without.weight));
  EXPECT_TRUE (sameBytes (with.weighted_target, without.weighted_target));
  EXPECT_TRUE (sameBytes (with.count, without.count));
}

TEST (ImlsDataTermOutside, PointsReachIntoTheGrid)
{
  const VoxelGrid grid = testGrid ();
  const ImlsDataTerm data = gathered (grid, {pointAt (grid, -2, 3, 4)});
  EXPECT_NEAR (data.weight[grid.index (0, 3, 4)], std::exp (-4.0f), 1e-5f);
  EXPECT_EQ (data.weight[grid.index (2, 3, 4)], 0.0f);
  const ImlsDataTerm nothing = gathered (
      grid, {pointAt (grid, -4, 3, 4), pointAt (grid, 3, 3, 18), pointAt (grid, 3, -5, 3)});
  EXPECT_EQ (*std::max_element (nothing.count.begin (), nothing.count.end ()), 0.0f);
}
