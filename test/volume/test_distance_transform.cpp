// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace pcl::cosection;

namespace {

std::vector<std::uint8_t>
randomMask (const Eigen::Vector3i& dims, unsigned seed, double share)
{
  std::mt19937 random (seed);
  std::bernoulli_distribution chosen (share);
  std::vector<std::uint8_t> mask (static_cast<std::size_t> (dims.prod ()));
  for (auto& m : mask)
    m = (chosen (random) ? 7 : 0);
  return mask;
}

std::vector<float>
bruteForce (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& mask)
{
  const auto position = [&] (int n) {
    return Eigen::Vector3i (n % dims.x (), n / dims.x () % dims.y (), n / (dims.x () * dims.y ()));
  };
  std::vector<float> distance (mask.size (), std::numeric_limits<float>::infinity ());
  for (int a = 0; a < dims.prod (); ++a)
    for (int b = 0; b < dims.prod (); ++b)
      if (mask[b] != 0)
        distance[a] = std::min (distance[a],
                                std::sqrt (static_cast<float> ((position (a) - position (b)).squaredNorm ())));
  return distance;
}

} // namespace

TEST (DistanceTransform, EqualsBruteForce)
{
  const std::vector<Eigen::Vector3i> sizes = {{1, 1, 1},   {9, 1, 1},   {1, 8, 1}, {1, 1, 7},
                                              {13, 11, 9}, {17, 16, 5}, {33, 3, 6}};
  unsigned seed = 0;
  for (const auto& dims : sizes)
    for (const double share : {0.002, 0.02, 0.3, 1.0})
    {
      const auto mask = randomMask (dims, ++seed, share);
      EXPECT_EQ (distanceTransform (dims, mask, 1), bruteForce (dims, mask)) << dims.transpose () << ", " << share;
    }
}

TEST (DistanceTransform, IsInfiniteWithoutAnyTarget)
{
  for (const float d : distanceTransform ({4, 5, 6}, std::vector<std::uint8_t> (120, 0)))
    EXPECT_EQ (d, std::numeric_limits<float>::infinity ());
}

TEST (DistanceTransform, DoesNotDependOnTheNumberOfThreads)
{
  const Eigen::Vector3i dims (40, 30, 35);
  const auto mask = randomMask (dims, 3, 0.001);
  const auto one = distanceTransform (dims, mask, 1);
  EXPECT_EQ (one, distanceTransform (dims, mask, 2));
  EXPECT_EQ (one, distanceTransform (dims, mask, 7));
}

TEST (DistanceTransform, IsExactOverLongDistances)
{
  const Eigen::Vector3i dims (3000, 2, 2);
  std::vector<std::uint8_t> mask (12000, 0);
  mask[0] = 1;
  EXPECT_FLOAT_EQ (distanceTransform (dims, mask).back (), std::sqrt (2999.0f * 2999.0f + 2.0f));
}

TEST (DistanceTransform, RefusesMasksOfAnotherSize)
{
  EXPECT_THROW (distanceTransform ({2, 2, 2}, std::vector<std::uint8_t> (7)), InvalidArgument);
  EXPECT_TRUE (distanceTransform ({0, 2, 2}, {}).empty ());
}
