// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/small_meshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

using namespace pcl::cosection;

TEST (MassProperties, OfABox)
{
  for (const float shift : {0.0f, 50.0f})
  {
    const Eigen::Vector3f lower (shift + 1, -2, 0.5f);
    const auto mass = computeMassProperties (test::boxMesh (lower, lower + Eigen::Vector3f (1, 2, 3)));
    EXPECT_NEAR (mass.volume_m3, 6.0, 1e-9);
    EXPECT_TRUE (mass.centroid_m.isApprox (Eigen::Vector3d (shift + 1.5, -1, 2), 1e-9));
    const Eigen::Vector3d expected = 6.0 / 12.0 * Eigen::Vector3d (4 + 9, 1 + 9, 1 + 4);
    EXPECT_LT ((mass.inertia - Eigen::Matrix3d (expected.asDiagonal ())).norm (), 1e-8);
  }
}

TEST (MassProperties, TurnWithTheBody)
{
  auto mesh = test::torusMesh (1.0, 0.3, 30, 20);
  const auto before = computeMassProperties (mesh);
  const Eigen::Isometry3d T = Eigen::Translation3d (0.5, -2, 3) *
                              Eigen::AngleAxisd (1.1, Eigen::Vector3d (1, 2, -1).normalized ());
  for (auto& v : mesh.vertices)
    v = (T * v.cast<double> ()).cast<float> ();
  const auto after = computeMassProperties (mesh);
  EXPECT_NEAR (after.volume_m3, before.volume_m3, 1e-5);
  EXPECT_LT ((after.centroid_m - T * before.centroid_m).norm (), 1e-5);
  EXPECT_LT ((after.inertia - T.linear () * before.inertia * T.linear ().transpose ()).norm (), 1e-5);
}

TEST (MassProperties, OfASphereConverge)
{
  const double r = 0.5;
  const double volume = 4.0 / 3.0 * M_PI * r * r * r;
  double last_error = 1.0;
  for (const std::uint32_t n : {8u, 16u, 32u})
  {
    const auto mass = computeMassProperties (test::sphereMesh (r, n));
    const double error = std::abs (mass.volume_m3 / volume - 1.0);
    EXPECT_LT (error, 0.3 * last_error);
    EXPECT_NEAR (mass.inertia (2, 2), 0.4 * volume * r * r, 2.0 * error * volume * r * r);
    last_error = error;
  }
}

TEST (MassProperties, OfNothingAreZero)
{
  EXPECT_EQ (computeMassProperties ({}).volume_m3, 0.0);
}
