// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What the tests of real data measure with.

#include "mesh_measures.h"

#include "common/small_meshes.h"
#include "common/temporary_folder.h"
#include "common/triangle_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

TEST (MeshMeasures, DistanceToTriangleInEveryRegion)
{
  const Eigen::Vector3d a (0, 0, 0), b (1, 0, 0), c (0, 1, 0);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({0.2, 0.2, -0.5}, a, b, c), 0.5);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({-3, 0, 4}, a, b, c), 5.0);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({2, 0, 0}, a, b, c), 1.0);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({0, 4, 4}, a, b, c), 5.0);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({0.5, -2, 0}, a, b, c), 2.0);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({-2, 0.5, 0}, a, b, c), 2.0);
  EXPECT_NEAR (distanceToTriangle ({1, 1, 0}, a, b, c), std::sqrt (0.5), 1e-15);
  EXPECT_DOUBLE_EQ (distanceToTriangle ({0, 3, 0}, a, a, b), 3.0); // no area
}

TEST (MeshMeasures, DistanceToMeshEqualsBruteForce)
{
  const TriangleMesh mesh = torusMesh (1.0, 0.3, 48, 24);
  const ExactMeshDistance distance (mesh);
  std::mt19937 random (1);
  std::uniform_real_distribution<double> uniform (-2.0, 2.0);
  for (int i = 0; i < 500; ++i)
  {
    const Eigen::Vector3d p (uniform (random), uniform (random), uniform (random));
    const double expected = bruteForceSurfaceDistance (mesh, p);
    EXPECT_EQ (distance (p), expected);
    EXPECT_NEAR (expected, std::abs (std::hypot (std::hypot (p.x (), p.y ()) - 1.0, p.z ()) - 0.3), 0.006);
  }
  EXPECT_TRUE (std::isinf (ExactMeshDistance (TriangleMesh ()) ({0, 0, 0})));
}

TEST (MeshMeasures, SamplesAreUniformByArea)
{
  const TriangleMesh box = boxMesh ({0, 0, 0}, {4, 1, 1});
  const std::vector<Eigen::Vector3d> samples = sampleByArea (box, 20000, 7);
  ASSERT_EQ (samples.size (), 20000u);
  const ExactMeshDistance distance (box);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  int top = 0;
  for (const Eigen::Vector3d& p : samples)
  {
    EXPECT_LT (distance (p), 1e-12);
    mean += p / 20000.0;
    top += p.z () > 1.0 - 1e-12;
  }
  EXPECT_LT ((mean - Eigen::Vector3d (2.0, 0.5, 0.5)).norm (), 0.05);
  EXPECT_NEAR (top / 20000.0, 4.0 / 18.0, 0.01);
  EXPECT_EQ (sampleByArea (box, 10, 7)[9], samples[9]);
}

TEST (MeshMeasures, PercentileAndBox)
{
  std::vector<double> values;
  std::vector<Eigen::Vector3d> points;
  for (int i = 100; i > 0; --i)
  {
    values.push_back (i);
    points.emplace_back (i == 100 ? 1e6 : 3.0 * i, 4.0 * i, 0.0);
  }
  EXPECT_EQ (percentile (values, 0.99), 99.0);
  EXPECT_EQ (percentile (values, 0.0), 1.0);
  EXPECT_EQ (percentile (values, 1.0), 100.0);
  EXPECT_DOUBLE_EQ (boxDiagonal (points, 0.01), 5.0 * 98.0);
}

TEST (MeshMeasures, DominantPlaneAmongOutliers)
{
  const Eigen::Vector3d normal = Eigen::Vector3d (0.1, -0.7, -0.7).normalized ();
  std::mt19937 random (3);
  std::uniform_real_distribution<double> uniform (-0.4, 0.4);
  std::normal_distribution<double> noise (0.0, 0.002);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 3000; ++i)
  {
    const Eigen::Vector3d p (uniform (random), uniform (random), 1.0 + uniform (random));
    points.push_back (i % 3 == 0 ? p : Eigen::Vector3d (p - normal * (normal.dot (p) + 0.8 + noise (random))));
  }
  const std::optional<FittedPlane> plane = fitDominantPlane (points, 0.01, 1);
  ASSERT_TRUE (plane);
  EXPECT_GT (plane->normal.dot (normal), 0.9999);
  EXPECT_NEAR (plane->d, 0.8, 0.001);
  EXPECT_GT (plane->height ({0, 0, 0}), 0.0);
  EXPECT_FALSE (fitDominantPlane ({}, 0.01, 1));
}

TEST (MeshMeasures, VolumeBoxFromHeader)
{
  const TemporaryFolder folder;
  writeFile (folder.file ("a.vti"), "<VTKFile type=\"ImageData\">\n<ImageData WholeExtent=\"0 9 0 19 0 29\" "
                                    "Origin=\"-1 0.5 2e-1\" Spacing=\"0.1 0.1 0.1\">\n");
  const std::optional<VolumeBox> volume = readVolumeBox (folder.file ("a.vti"));
  ASSERT_TRUE (volume);
  EXPECT_EQ (volume->voxel_size_m, 0.1);
  EXPECT_TRUE (volume->centres.min ().isApprox (Eigen::Vector3d (-1.0, 0.5, 0.2)));
  EXPECT_TRUE (volume->centres.max ().isApprox (Eigen::Vector3d (-0.1, 2.4, 3.1)));
  EXPECT_FALSE (readVolumeBox (folder.file ("missing.vti")));
}

} // namespace
