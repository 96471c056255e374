// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include <pcl/cosection/volume/signed_distance_field.h>

#include <gtest/gtest.h>

#include <limits>

using namespace pcl::cosection;

namespace {

double
trilinear (const Eigen::Vector3d& p)
{
  return 1.0 + 2.0 * p.x () - 3.0 * p.y () + 0.5 * p.z () + p.x () * p.y () - 4.0 * p.x () * p.y () * p.z ();
}

SignedDistanceField
trilinearField ()
{
  SignedDistanceField field;
  field.grid.dims = {4, 3, 5};
  field.grid.voxel_size_m = 0.25;
  field.grid.origin_m = {-1.0, 0.5, 2.0};
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        field.values.push_back (static_cast<float> (trilinear (field.grid.center (i, j, k))));
  return field;
}

} // namespace

TEST (SignedDistanceField, ReproducesTrilinearFunctions)
{
  const auto field = trilinearField ();
  for (const double x : {0.0, 0.3, 1.0, 2.9, 3.0})
    for (const double y : {0.0, 1.2, 2.0})
      for (const double z : {0.0, 3.7, 4.0})
      {
        const Eigen::Vector3d p = field.grid.origin_m + field.grid.voxel_size_m * Eigen::Vector3d (x, y, z);
        const auto value = field.sample (p);
        ASSERT_TRUE (value.has_value ());
        EXPECT_NEAR (*value, trilinear (p), 1e-5);
      }
}

TEST (SignedDistanceField, KnowsNothingOutsideTheBoxOfVoxelCentres)
{
  const auto field = trilinearField ();
  const double nan = std::numeric_limits<double>::quiet_NaN ();
  const double inf = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3d& v :
       {Eigen::Vector3d (-0.01, 1, 1), Eigen::Vector3d (3.01, 1, 1), Eigen::Vector3d (1, 2.01, 1),
        Eigen::Vector3d (1, 1, -1e30), Eigen::Vector3d (nan, 1, 1), Eigen::Vector3d (1, 1, inf)})
    EXPECT_FALSE (field.sample (field.grid.origin_m + field.grid.voxel_size_m * v).has_value ());
}

TEST (SignedDistanceField, IgnoresMissingValuesOfNoWeight)
{
  auto field = trilinearField ();
  field.values[field.grid.index (2, 1, 1)] = std::numeric_limits<float>::quiet_NaN ();
  EXPECT_TRUE (field.sample (field.grid.center (1, 1, 1)).has_value ());
  EXPECT_FALSE (field.sample (field.grid.center (2, 1, 1)).has_value ());
}

TEST (SignedDistanceField, SupportIsThatOfTheNearestVoxel)
{
  auto field = trilinearField ();
  const Eigen::Vector3d p = field.grid.origin_m + field.grid.voxel_size_m * Eigen::Vector3d (1.4, 1.0, 2.6);
  EXPECT_EQ (field.sampleSupported (p), field.sample (p)); // empty: supported everywhere
  field.supported.assign (field.values.size (), 0);
  EXPECT_FALSE (field.sampleSupported (p).has_value ());
  field.supported[field.grid.index (1, 1, 3)] = 1;
  EXPECT_EQ (field.sampleSupported (p), field.sample (p));
}

TEST (SignedDistanceField, MayBeOneVoxelThick)
{
  SignedDistanceField field;
  field.grid.dims = {2, 1, 1};
  field.grid.voxel_size_m = 1.0;
  field.values = {1.0f, 3.0f};
  EXPECT_FLOAT_EQ (field.sample ({0.5, 0.0, 0.0}).value (), 2.0f);
  EXPECT_FALSE (field.sample ({0.5, 0.1, 0.0}).has_value ());
}
