// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/energy/constraints/hull_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

using namespace pcl::cosection;

namespace {

/** \brief Distance to the nearest voxel, in or around the volume, that is not free. */
std::vector<float>
distanceByDefinition (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& free_space)
{
  VoxelGrid grid;
  grid.dims = dims;
  std::vector<Eigen::Vector3i> hull;
  for (int k = -1; k <= dims.z (); ++k)
    for (int j = -1; j <= dims.y (); ++j)
      for (int i = -1; i <= dims.x (); ++i)
        if (!grid.contains (i, j, k) || !free_space[grid.index (i, j, k)])
          hull.emplace_back (i, j, k);
  std::vector<float> distance;
  for (int k = 0; k < dims.z (); ++k)
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
      {
        int nearest = std::numeric_limits<int>::max ();
        for (const Eigen::Vector3i& h : hull)
          nearest = std::min (nearest, (h - Eigen::Vector3i (i, j, k)).squaredNorm ());
        distance.push_back (std::sqrt (static_cast<float> (nearest)));
      }
  return distance;
}

class HullDistanceTest : public testing::TestWithParam<std::tuple<Eigen::Vector3i, double>>
{};

} // namespace

TEST_P (HullDistanceTest, EqualsTheDefinition)
{
  const auto& [dims, share] = GetParam ();
  std::mt19937 generator (5);
  std::bernoulli_distribution free_voxel (share);
  std::vector<std::uint8_t> free_space (dims.prod ());
  for (std::uint8_t& f : free_space)
    f = free_voxel (generator);
  const std::vector<float> expected = distanceByDefinition (dims, free_space);
  for (const int threads : {1, 2})
  {
    const std::vector<float> distance = hullDistance (dims, free_space, threads);
    ASSERT_EQ (distance.size (), expected.size ());
    for (std::size_t n = 0; n < distance.size (); ++n)
      ASSERT_NEAR (distance[n], expected[n], 1e-5f) << "voxel " << n;
  }
}

INSTANTIATE_TEST_SUITE_P (Masks, HullDistanceTest,
                          testing::Combine (testing::Values (Eigen::Vector3i (9, 7, 11), Eigen::Vector3i (1, 8, 5),
                                                             Eigen::Vector3i (12, 2, 3)),
                                            testing::Values (0.0, 0.5, 0.95, 0.995, 1.0)));
