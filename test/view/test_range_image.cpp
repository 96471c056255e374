// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/scenes/completion_scene.h"

#include "pcl_cosection/view/range_image.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Points of a shape on a table, and of the table, as one sensor sees them. */
std::vector<Eigen::Vector3f>
seenPoints (Shape shape)
{
  std::vector<Eigen::Vector3f> points;
  for (const auto& [label, some] : tableScene (shape).render (tableCamera (), fromAbove ()).points)
    for (const OrientedPoint& p : some)
      points.push_back (p.position);
  return points;
}

std::vector<Eigen::Vector3f>
spherePoints (int count, double radius_m)
{
  std::mt19937 random (1);
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> points;
  for (int n = 0; n < count; ++n)
    points.push_back (Eigen::Vector3f (normal (random), normal (random), normal (random)).normalized () *
                      static_cast<float> (radius_m));
  return points;
}

class RangeImageOf : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (RangeImageOf, AViewShowsItsPoints)
{
  const std::vector<Eigen::Vector3f> points = seenPoints (GetParam ());
  const auto image = drawRangeImage (points, fromAbove ().translation ());
  ASSERT_TRUE (image);
  EXPECT_LE (image->hidden_share, 0.01);
  const Eigen::Isometry3d T_sensor_world = image->view.T_world_sensor.inverse ();
  EXPECT_LT ((image->view.T_world_sensor.translation () - fromAbove ().translation ()).norm (), 1e-9);
  std::size_t readings = 0;
  for (const float z : image->view.depth)
    readings += std::isfinite (z);
  EXPECT_GE (points.size (), 2 * readings);                 // some points in each pixel that has any
  EXPECT_GE (readings * 10, image->view.depth.size () * 2); // and not all points in a few pixels
  const PinholeCamera& camera = image->view.camera;
  for (const Eigen::Vector3f& point : points)
  {
    const Eigen::Vector3d p = T_sensor_world * point.cast<double> ();
    const Eigen::Vector2d pixel = camera.project (p);
    const float depth = image->view.at (static_cast<int> (std::lround (pixel.x ())),
                                        static_cast<int> (std::lround (pixel.y ())));
    ASSERT_TRUE (std::isfinite (depth));
    ASSERT_LE (depth, p.z () + 1e-5); // never more free space than there is
  }
}

INSTANTIATE_TEST_SUITE_P (Shapes, RangeImageOf, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (RangeImage, KnowsThatASensorCannotHaveStoodThere)
{
  const auto image = drawRangeImage (spherePoints (20000, 0.1), {0.0, 0.0, -1.0});
  ASSERT_TRUE (image);
  EXPECT_GT (image->hidden_share, 0.3); // the far side of a ball
  EXPECT_LT (image->hidden_share, 0.6);
}

TEST (RangeImage, NeedsPointsBeforeTheSensor)
{
  const std::vector<Eigen::Vector3f> ball = spherePoints (2000, 0.1);
  EXPECT_FALSE (drawRangeImage ({}, Eigen::Vector3d::Zero ()));
  EXPECT_FALSE (drawRangeImage (ball, Eigen::Vector3d::Zero ()));          // within
  EXPECT_FALSE (drawRangeImage (ball, {0.0, 0.0, 0.11}));                  // too near: they span more than 120 degrees
  EXPECT_FALSE (drawRangeImage (spherePoints (20, 0.1), {0.0, 0.0, 1.0})); // too few
  EXPECT_FALSE (drawRangeImage (ball, {0.0, 0.0, std::nan ("")}));
  EXPECT_FALSE (
      drawRangeImage (std::vector<Eigen::Vector3f> (100, Eigen::Vector3f::Constant (std::nanf (""))), {0, 0, 1}));
  EXPECT_TRUE (drawRangeImage (std::vector<Eigen::Vector3f> (100, Eigen::Vector3f::Ones ()), {0, 0, 0})); // one spot
}

TEST (RangeImage, IsTheDepthViewOfAnUnorganizedCloud)
{
  const Eigen::Isometry3d T = fromAbove ();
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const Eigen::Vector3f& point : seenPoints (Shape::Box))
  {
    const Eigen::Vector3f p = (T.inverse () * point.cast<double> ()).cast<float> ();
    cloud.emplace_back (p.x (), p.y (), p.z ());
  }
  const auto view = toDepthView (cloud, T);
  ASSERT_TRUE (view);
  EXPECT_LT ((view->T_world_sensor.translation () - T.translation ()).norm (), 1e-6);
  for (pcl::PointXYZ& p : cloud) // all around the origin
    p.z -= cloud.front ().z;
  EXPECT_FALSE (toDepthView (cloud, T));
}
