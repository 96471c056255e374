// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "distance_meshes.h"

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;
using test::bin;
using test::cubicGrid;
using test::forEachVoxel;
using test::square;
using test::united;

TEST (MeshDistanceSheets, AnOpenSheetSpeaksInFrontAndBehindOnly)
{
  const float half = 0.1f;
  const double band = 0.035;
  const auto field = sampleSignedDistance (square (half), cubicGrid ({0.004, 0.002, 0.001}, 41, 0.01), band);
  ASSERT_EQ (field.supported.size (), field.grid.size ());
  int supported = 0;
  forEachVoxel (field, [&] (const Eigen::Vector3d& p, std::size_t n) {
    const bool beside = p.head<2> ().cwiseAbs ().maxCoeff () > half;
    EXPECT_EQ (field.supported[n] != 0, !beside && std::abs (p.z ()) <= band) << p.transpose ();
    if (field.supported[n] != 0)
    {
      EXPECT_NEAR (field.values[n], p.z (), 1e-6);
    }
    supported += field.supported[n];
  });
  EXPECT_GT (supported, 20 * 20 * 6);
  // Interpolation at the rim of the supported region invents no values.
  std::mt19937 random (1);
  std::uniform_real_distribution<double> uniform (-0.15, 0.15);
  for (int trial = 0; trial < 20000; ++trial)
  {
    const Eigen::Vector3d p (uniform (random), uniform (random), uniform (random));
    const auto u = field.sampleSupported (p);
    EXPECT_NEAR (u.value_or (static_cast<float> (p.z ())), p.z (), 0.01) << p.transpose ();
  }
}

TEST (MeshDistanceSheets, ABinIsFreeInsideAndMatterBehindItsWalls)
{
  const Eigen::Vector3f half (0.1f, 0.15f, 0.08f);
  const auto box = test::box (half.cast<double> ());
  const double band = 0.04;
  const auto field = sampleSignedDistance (bin (half), cubicGrid ({0, 0, 0}, 40, 0.0101), band);
  ASSERT_EQ (field.supported.size (), field.grid.size ());
  int free = 0, matter = 0;
  forEachVoxel (field, [&] (const Eigen::Vector3d& p, std::size_t n) {
    const bool below_rim = p.z () <= half.z ();
    const double to_wall = std::max (
        {std::abs (p.x ()) - half.x (), std::abs (p.y ()) - half.y (), -p.z () - half.z ()});
    if (field.supported[n] == 0)
    {
      // Above the rim, or nearer to it than to all walls, or too far from everything.
      EXPECT_TRUE (!below_rim || std::abs (to_wall) > band || std::abs (box (p)) > band) << p.transpose ();
      return;
    }
    EXPECT_TRUE (below_rim) << p.transpose ();
    EXPECT_NEAR (field.values[n], to_wall < 0.0 ? -to_wall : -box (p), 1e-6) << p.transpose ();
    (to_wall < 0.0 ? free : matter) += 1;
  });
  EXPECT_GT (free, 1000);
  EXPECT_GT (matter, 1000);
}

TEST (MeshDistanceSheets, AMeshOfClosedAndOpenPartsSaysWhatBothSay)
{
  const TriangleMesh box = test::boxMesh ({-0.05f, -0.05f, 0.05f}, {0.05f, 0.05f, 0.15f});
  const auto distance = test::box ({0.05, 0.05, 0.05});
  const double band = 0.03;
  const auto field = sampleSignedDistance (united (square (0.1f), box), cubicGrid ({0, 0, 0.05}, 31, 0.0101), band);
  ASSERT_EQ (field.supported.size (), field.grid.size ());
  forEachVoxel (field, [&] (const Eigen::Vector3d& p, std::size_t n) {
    const double to_box = distance (p - Eigen::Vector3d (0, 0, 0.1));
    const bool sheet = p.head<2> ().cwiseAbs ().maxCoeff () <= 0.1 && std::abs (p.z ()) <= band;
    EXPECT_EQ (field.supported[n] != 0, sheet || to_box < band) << p.transpose ();
    const double truth = std::max (-band, sheet ? std::min (p.z (), to_box) : to_box);
    EXPECT_NEAR (field.supported[n] != 0 ? field.values[n] : truth, truth, 1e-6) << p.transpose ();
  });
}
