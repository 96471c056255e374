// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "analytic_fields.h"
#include "tsdf_views.h"

#include <pcl/cosection/volume/signed_distance_field.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace pcl::cosection;

TEST (TrilinearCell, IsTheInterpolatedValueAndItsDerivative)
{
  const auto field = test::sampleField (test::torus (0.08, 0.03), 0.13, 0.01);
  std::mt19937 random (3);
  std::uniform_real_distribution<double> uniform (-0.12, 0.12);
  int checked = 0;
  for (int n = 0; n < 1000; ++n)
  {
    const Eigen::Vector3d p (uniform (random), uniform (random), uniform (random));
    const auto cell = TrilinearCell<double>::around (field, p);
    ASSERT_TRUE (cell);
    EXPECT_NEAR (cell->value (), *field.sample (p), 1e-6);
    const auto single = TrilinearCell<float>::around (field, p.cast<float> ());
    ASSERT_TRUE (single);
    EXPECT_NEAR (single->value (), cell->value (), 1e-6);
    const Eigen::Vector3d v = field.grid.toVoxel (p);
    const Eigen::Array3d fraction = v.array () - v.array ().floor ();
    if ((fraction < 0.01).any () || (fraction > 0.99).any ())
      continue; // the derivative jumps from cell to cell
    for (int axis = 0; axis < 3; ++axis)
    {
      const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit (axis);
      const double slope = (TrilinearCell<double>::around (field, p + step)->value () -
                            TrilinearCell<double>::around (field, p - step)->value ()) /
                           2e-5;
      EXPECT_NEAR (cell->gradient ()[axis], slope, 1e-6);
      EXPECT_NEAR (single->gradient ()[axis], slope, 1e-3);
    }
    ++checked;
  }
  EXPECT_GT (checked, 800);
}

TEST (TrilinearCell, ExistsOnTheBoundsAndNowhereBeyond)
{
  const auto field = test::sampleField (test::sphere (0.02), 0.03, 0.01);
  const int end = field.grid.dims.x () - 1;
  const Eigen::Vector3d last = field.grid.center (end, end, end);
  EXPECT_NEAR (TrilinearCell<double>::around (field, last)->value (), field.values.back (), 1e-7);
  EXPECT_NEAR (TrilinearCell<double>::around (field, field.grid.origin_m)->value (), field.values.front (), 1e-7);
  EXPECT_FALSE (TrilinearCell<double>::around (field, last + Eigen::Vector3d (1e-6, 0.0, 0.0)));
  EXPECT_FALSE (TrilinearCell<double>::around (field, field.grid.origin_m - Eigen::Vector3d (0.0, 0.0, 1e-6)));
  const double nan = std::numeric_limits<double>::quiet_NaN ();
  for (const double bad : {nan, std::numeric_limits<double>::infinity (), -1e300, 1e300})
    EXPECT_FALSE (TrilinearCell<double>::around (field, Eigen::Vector3d (0.0, bad, 0.0)));
}

TEST (TrilinearCell, NothingWhereACornerHasNoWeight)
{
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.0, 0.0, -0.5});
  TsdfVolume volume (test::cubeGrid (32, 0.01));
  const Eigen::Vector3d surface (0.003, 0.002, 0.0);
  EXPECT_FALSE (volume.sample (surface));
  volume.integrate (test::renderDepth (test::planeRay ({0.0, 0.0, 1.0}, 0.0), camera, pose), camera, pose);
  ASSERT_TRUE (volume.sample (surface));
  EXPECT_NEAR (volume.sample (surface)->value (), 0.0, 1e-4);
  EXPECT_LT ((volume.sample (surface)->gradient () - Eigen::Vector3d (0.0, 0.0, -1.0)).norm (), 0.02);
  EXPECT_NEAR (volume.sample (Eigen::Vector3f (0.003f, 0.002f, 0.02f))->value (), -0.02f, 1e-4);
  // The last cell with eight weights ends ten voxels behind the surface.
  EXPECT_TRUE (volume.sample (Eigen::Vector3d (0.003, 0.002, 0.094)));
  EXPECT_FALSE (volume.sample (Eigen::Vector3d (0.003, 0.002, 0.096)));
}
