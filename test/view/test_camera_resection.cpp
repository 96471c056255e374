// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/not_a_number.h"

#include "pcl_cosection/view/camera_resection.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int image_width = 80;
constexpr int image_height = 60;
const PinholeCamera truth{image_width, image_height, 71.0, 73.5, 38.2, 31.7};

/** \brief The image of a surface with depths within \a relief_m of 1.3 m and Gaussian noise of \a noise_px on the
 * pixels. */
std::vector<Eigen::Vector3f>
image (double relief_m, double noise_px = 0.0)
{
  std::mt19937 random (3);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> uniform (-0.5, 0.5);
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < image_height; ++v)
    for (int u = 0; u < image_width; ++u)
      points.push_back (truth
                            .unproject (u + noise_px * noise (random), v + noise_px * noise (random),
                                        1.3 + relief_m * uniform (random))
                            .cast<float> ());
  return points;
}

std::vector<Eigen::Vector3f>
moved (const Eigen::Isometry3d& T, std::vector<Eigen::Vector3f> points)
{
  for (Eigen::Vector3f& p : points)
    p = T.cast<float> () * p;
  return points;
}

Eigen::Isometry3d
somePose (unsigned seed)
{
  std::mt19937 random (seed);
  std::normal_distribution<double> gauss;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.translate (Eigen::Vector3d (gauss (random), gauss (random), gauss (random)));
  T.rotate (Eigen::Quaterniond (gauss (random), gauss (random), gauss (random), gauss (random)).normalized ());
  return T;
}

void
expectLocated (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T, double within_m,
               double within_px)
{
  const auto located = locateCamera (points, image_width, image_height);
  ASSERT_TRUE (located);
  EXPECT_LT ((located->T_points_sensor.translation () - T.translation ()).norm (), within_m);
  EXPECT_LT ((located->T_points_sensor.linear () - T.linear ()).norm (), within_m);
  EXPECT_NEAR (located->camera.fx, truth.fx, within_px);
  EXPECT_NEAR (located->camera.fy, truth.fy, within_px);
  EXPECT_NEAR (located->camera.cx, truth.cx, within_px);
  EXPECT_NEAR (located->camera.cy, truth.cy, within_px);
}

} // namespace

TEST (LocateCamera, FindsTheSensorInAnyFrame)
{
  for (unsigned seed = 0; seed < 20; ++seed)
    expectLocated (moved (somePose (seed), image (0.5)), somePose (seed), 1e-4, 0.01);
}

/** \brief A nearly flat surface determines the camera if its relief exceeds the depth noise; rounding is much smaller.
 */
TEST (LocateCamera, MillimetresOfReliefAreEnough)
{
  expectLocated (moved (somePose (1), image (0.003)), somePose (1), 0.02, 1.0);
}

TEST (LocateCamera, BearsPixelsThatAreSlightlyOff)
{
  expectLocated (moved (somePose (2), image (0.8, 0.1)), somePose (2), 0.02, 1.0);
}

TEST (LocateCamera, LeavesOutMissingReadings)
{
  auto points = image (0.5);
  std::mt19937 random (5);
  for (Eigen::Vector3f& p : points)
    if (random () % 3 == 0)
      p.setConstant (random () % 2 == 0 ? not_a_number : 0.0f); // a moved zero looks like a reading
  const Eigen::Isometry3d T = somePose (4);
  expectLocated (moved (T, points), T, 1e-4, 0.01);
  const auto seen = takeToSensor (T.inverse (), moved (T, points));
  for (std::size_t i = 0; i < points.size (); ++i)
    EXPECT_EQ (seen[i].allFinite (), points[i].allFinite () && !points[i].isZero ());
}

TEST (LocateCamera, RefusesWhatDoesNotTell)
{
  const Eigen::Isometry3d T = somePose (6);
  EXPECT_FALSE (locateCamera (moved (T, image (0.0)), image_width, image_height)); // a plane
  EXPECT_FALSE (locateCamera (moved (T, image (0.8, 2.0)), image_width, image_height));
  EXPECT_FALSE (locateCamera (moved (T, image (0.8)), image_width * image_height, 1)); // unorganised
  auto mirrored = image (0.5);
  for (Eigen::Vector3f& p : mirrored)
    p.x () = -p.x ();
  EXPECT_FALSE (locateCamera (moved (T, mirrored), image_width, image_height));
  std::vector<Eigen::Vector3f> orthographic;
  for (int v = 0; v < image_height; ++v)
    for (int u = 0; u < image_width; ++u)
      orthographic.emplace_back (0.01f * u - 0.4f, 0.01f * v - 0.3f,
                                 1.0f + 0.02f * static_cast<float> ((u * 7 + v * 13) % 20));
  EXPECT_FALSE (locateCamera (moved (T, orthographic), image_width, image_height));
  for (Eigen::Vector3f& p : orthographic) // nearly
    p.x () += 0.001f * p.z () * p.y ();
  EXPECT_FALSE (locateCamera (moved (T, orthographic), image_width, image_height));
  const std::size_t pixels = static_cast<std::size_t> (image_width) * image_height;
  EXPECT_FALSE (locateCamera (std::vector<Eigen::Vector3f> (pixels, Eigen::Vector3f::Constant (not_a_number)),
                              image_width, image_height));
  EXPECT_FALSE (locateCamera (std::vector<Eigen::Vector3f> (pixels, Eigen::Vector3f (1.0f, 2.0f, 3.0f)), image_width,
                              image_height));
  EXPECT_FALSE (locateCamera (std::vector<Eigen::Vector3f> (pixels, Eigen::Vector3f::Constant (3e38f)), image_width,
                              image_height));
  EXPECT_THROW (locateCamera ({}, image_width, image_height), InvalidArgument);
}

TEST (OrganizedDepthView, IsTheSameInAnyFrame)
{
  const auto points = image (0.5);
  const Eigen::Isometry3d T = somePose (7), T_world_points = somePose (8);
  const auto plain = toDepthView (points, image_width, image_height, T_world_points * T);
  const auto view = toDepthView (moved (T, points), image_width, image_height, T_world_points);
  ASSERT_TRUE (plain && view);
  EXPECT_TRUE (plain->T_world_sensor.isApprox (T_world_points * T));
  EXPECT_LT ((view->T_world_sensor.matrix () - plain->T_world_sensor.matrix ()).norm (), 1e-3);
  for (std::size_t i = 0; i < points.size (); ++i)
    ASSERT_NEAR (view->depth[i], plain->depth[i], 1e-3f);
}
