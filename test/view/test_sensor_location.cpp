// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/scenes/completion_scene.h"

#include "pcl_cosection/view/sensor_location.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Isometry3d elsewhere = motion (2.0, {1.0, -2.0, 0.5}, {3.0, -1.0, 2.0});

/** \brief The points of a camera image, row by row, in another frame, with depth noise and without a share of the
 * readings. */
std::vector<Eigen::Vector3f>
imageOf (Shape shape, double missing)
{
  const DepthView view = tableScene (shape).render (tableCamera (), fromAbove ()).view;
  std::mt19937 random (4);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform;
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
      if (const double z = view.at (u, v); std::isfinite (z) && uniform (random) >= missing)
        points.push_back ((elsewhere * view.T_world_sensor * view.camera.unproject (u, v, z + 0.0005 * gauss (random)))
                              .cast<float> ());
  return points;
}

double
nearestTo (const Eigen::Vector3d& place, const std::vector<Eigen::Vector3d>& places)
{
  double least = INFINITY;
  for (const Eigen::Vector3d& other : places)
    least = std::min (least, (other - place).norm ());
  return least;
}

class LocateSensor : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (LocateSensor, IsFoundInAnyFrame)
{
  const Eigen::Vector3d sensor = elsewhere * fromAbove ().translation ();
  const double distance = fromAbove ().translation ().norm ();
  EXPECT_LT (nearestTo (sensor, locateSensor (imageOf (GetParam (), 0.0))), 0.02 * distance);
  EXPECT_LT (nearestTo (sensor, locateSensor (imageOf (GetParam (), 0.1))), 0.05 * distance);
}

INSTANTIATE_TEST_SUITE_P (Shapes, LocateSensor, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (LocateSensor, AMissingReadingAtTheSensorDoesNoHarm)
{
  auto points = imageOf (Shape::Box, 0.0);
  const Eigen::Vector3d sensor = elsewhere * fromAbove ().translation ();
  points.insert (points.begin () + 1000, sensor.cast<float> ());
  EXPECT_LT (nearestTo (sensor, locateSensor (points)), 0.01);
}

TEST (LocateSensor, NeedsTheOrder)
{
  auto points = imageOf (Shape::Box, 0.0);
  std::shuffle (points.begin (), points.end (), std::mt19937 (1));
  EXPECT_TRUE (locateSensor (points).empty ());
}

TEST (LocateSensor, NeedsSomethingBeforeSomethingElse)
{
  EXPECT_TRUE (locateSensor ({}).empty ());
  EXPECT_TRUE (locateSensor (std::vector<Eigen::Vector3f> (1000, Eigen::Vector3f::Ones ())).empty ());
  EXPECT_TRUE (locateSensor (std::vector<Eigen::Vector3f> (1000, Eigen::Vector3f::Constant (NAN))).empty ());
  std::vector<Eigen::Vector3f> table;
  for (int v = 0; v < 100; ++v)
    for (int u = 0; u < 100; ++u)
      table.emplace_back (0.01f * u, 0.01f * v, 0.0f);
  EXPECT_TRUE (locateSensor (table).empty ());
  for (Eigen::Vector3f& p : table) // absurdly large, but not infinite
    p *= 1e37f;
  EXPECT_TRUE (locateSensor (table).empty ());
}

TEST (BeginningsOfViews, AreFoundBySensors)
{
  const std::vector<Eigen::Vector3f> first = imageOf (Shape::Box, 0.1), second = imageOf (Shape::Cup, 0.1);
  EXPECT_TRUE (beginningsOfViews (first).empty ());
  std::vector<Eigen::Vector3f> merged = first;
  const Eigen::Affine3f turned (Eigen::AngleAxisf (1.0f, Eigen::Vector3f::UnitX ()));
  for (const Eigen::Vector3f& p : second)
    merged.push_back (turned * p);
  merged.insert (merged.end (), first.begin (), first.end ());
  const std::vector<std::size_t> beginnings = beginningsOfViews (merged);
  ASSERT_EQ (beginnings.size (), 3u);
  EXPECT_EQ (beginnings[0], 0u);
  EXPECT_EQ (beginnings[1], first.size ());
  EXPECT_EQ (beginnings[2], first.size () + second.size ());
  std::shuffle (merged.begin (), merged.end (), std::mt19937 (1));
  EXPECT_TRUE (beginningsOfViews (merged).empty ());
  EXPECT_TRUE (beginningsOfViews ({}).empty ());
}
