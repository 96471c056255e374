// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "priors/moved_points.h"

#include "pcl_cosection/view/support_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double noise_m = 0.001;

/** \brief Noisy points of a rectangle centre + a x + b y, |x|, |y| <= 1. */
std::vector<OrientedPoint>
rectangle (const Eigen::Vector3d& centre, const Eigen::Vector3d& a, const Eigen::Vector3d& b, int number)
{
  std::mt19937 generator (3);
  std::uniform_real_distribution<double> uniform (-1.0, 1.0);
  std::normal_distribution<double> gauss (0.0, noise_m);
  const Eigen::Vector3d normal = a.cross (b).normalized ();
  std::vector<OrientedPoint> points;
  for (int i = 0; i < number; ++i)
  {
    OrientedPoint point;
    point.position = (centre + uniform (generator) * a + uniform (generator) * b + gauss (generator) * normal)
                         .cast<float> ();
    point.normal = normal.cast<float> ();
    points.push_back (point);
  }
  return points;
}

/** \brief A table top at z = 0, half a metre each way. */
std::vector<OrientedPoint>
table (int number = 6000)
{
  return rectangle ({0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}, number);
}

/** \brief Front and top of a box of 0.1 m whose bottom is at \a base. */
std::vector<OrientedPoint>
boxOn (const Eigen::Vector3d& base)
{
  std::vector<OrientedPoint> points = rectangle (base + Eigen::Vector3d (0.0, -0.05, 0.05), {0.05, 0.0, 0.0},
                                                 {0.0, 0.0, 0.05}, 800);
  for (const OrientedPoint& p :
       rectangle (base + Eigen::Vector3d (0.0, 0.0, 0.1), {0.05, 0.0, 0.0}, {0.0, 0.05, 0.0}, 800))
    points.push_back (p);
  return points;
}

void
expectPlane (const Eigen::Vector4d& plane, const Eigen::Vector3d& normal, const Eigen::Vector3d& point)
{
  EXPECT_NEAR (plane.head<3> ().norm (), 1.0, 1e-6);
  EXPECT_GT (plane.head<3> ().dot (normal), std::cos (0.5 * M_PI / 180.0)) << plane.transpose ();
  EXPECT_NEAR (plane.head<3> ().dot (point) + plane[3], 0.0, noise_m) << plane.transpose ();
}

class SupportPlaneTest : public testing::TestWithParam<int> // seed of the scene's pose
{
protected:
  SupportPlaneTest ()
  {
    if (GetParam () == 0)
      return;
    std::mt19937 generator (GetParam ());
    std::uniform_real_distribution<double> uniform (-1.0, 1.0);
    const auto vector = [&] { return Eigen::Vector3d (uniform (generator), uniform (generator), uniform (generator)); };
    T_.linear () = Eigen::AngleAxisd (3.0 * uniform (generator), vector ().normalized ()).toRotationMatrix ();
    T_.translation () = vector ();
  }

  Eigen::Isometry3d T_ = Eigen::Isometry3d::Identity ();
};

} // namespace

TEST_P (SupportPlaneTest, IsFoundUnderABox)
{
  const auto planes = findSupportPlanes (moved (table (), T_), moved (boxOn ({0.1, 0.0, 0.0}), T_));
  ASSERT_EQ (planes.size (), 1u);
  expectPlane (planes[0], T_.linear () * Eigen::Vector3d::UnitZ (), T_ * Eigen::Vector3d (0.1, 0.0, 0.0));
}

TEST_P (SupportPlaneTest, IsFoundBehindABoxToo)
{
  std::vector<OrientedPoint> background = table ();
  for (const OrientedPoint& p : rectangle ({0.0, 0.08, 0.2}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.2}, 3000))
    background.push_back (p); // normal -y: towards the box
  const auto planes = findSupportPlanes (moved (background, T_), moved (boxOn ({0.0, 0.0, 0.0}), T_));
  ASSERT_EQ (planes.size (), 2u);
  const Eigen::Vector3d up = T_.linear () * Eigen::Vector3d::UnitZ ();
  const bool table_first = planes[0].head<3> ().dot (up) > 0.5;
  expectPlane (planes[table_first ? 0 : 1], up, T_ * Eigen::Vector3d::Zero ());
  expectPlane (planes[table_first ? 1 : 0], -(T_.linear () * Eigen::Vector3d::UnitY ()),
               T_ * Eigen::Vector3d (0.0, 0.08, 0.1));
}

TEST_P (SupportPlaneTest, IsNotForWhatLiesBelowOrAcross)
{
  const std::vector<OrientedPoint> background = moved (table (), T_);
  for (const double base : {-0.13, -0.05})
    EXPECT_TRUE (findSupportPlanes (background, moved (boxOn ({0.0, 0.0, base}), T_)).empty ()) << base;
}

TEST_P (SupportPlaneTest, IsTheSameEveryTime)
{
  const std::vector<OrientedPoint> background = moved (table (30000), T_);
  const std::vector<OrientedPoint> object = moved (boxOn ({0.0, 0.0, 0.0}), T_);
  const auto first = findSupportPlanes (background, object);
  ASSERT_FALSE (first.empty ());
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ (findSupportPlanes (background, object), first);
}

INSTANTIATE_TEST_SUITE_P (Poses, SupportPlaneTest, testing::Values (0, 1, 2));

TEST (SupportPlaneInliers, MustBeEnough)
{
  SupportPlaneOptions options;
  const std::vector<OrientedPoint> object = boxOn ({0.0, 0.0, 0.0});
  const std::vector<OrientedPoint> few = rectangle ({0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0},
                                                    options.min_inliers - 1);
  EXPECT_TRUE (findSupportPlanes (few, object, options).empty ());
  options.min_inliers = 150;
  EXPECT_EQ (findSupportPlanes (few, object, options).size (), 1u);
}

TEST (SupportPlaneInliers, MustBeNear)
{
  EXPECT_TRUE (findSupportPlanes (table (), boxOn ({2.0, 0.0, 0.0})).empty ());
  EXPECT_TRUE (findSupportPlanes (table (), {}).empty ());
  EXPECT_TRUE (findSupportPlanes ({}, boxOn ({0.0, 0.0, 0.0})).empty ());
}

/** \brief The normals of the points determine the free side, not the place of the object. */
TEST (SupportPlaneNormals, PointToFreeSpace)
{
  std::vector<OrientedPoint> ceiling = table ();
  for (OrientedPoint& p : ceiling)
    p.normal = -p.normal;
  EXPECT_TRUE (findSupportPlanes (ceiling, boxOn ({0.0, 0.0, 0.0})).empty ());
  const auto planes = findSupportPlanes (ceiling, boxOn ({0.0, 0.0, -0.11}));
  ASSERT_EQ (planes.size (), 1u);
  expectPlane (planes[0], -Eigen::Vector3d::UnitZ (), Eigen::Vector3d::Zero ());
}

TEST (SupportPlane, NoPlaneInALine)
{
  std::vector<OrientedPoint> line = rectangle ({0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}, 2000);
  for (OrientedPoint& p : line)
    p.position.tail<2> ().setZero ();
  testing::internal::CaptureStderr ();
  testing::internal::CaptureStdout ();
  EXPECT_TRUE (findSupportPlanes (line, boxOn ({0.0, 0.0, 0.0})).empty ());
  EXPECT_EQ (testing::internal::GetCapturedStdout (), "");
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "");
}

TEST (SupportPlane, NoPlaneInAFewPointsNearEachOther)
{
  std::vector<OrientedPoint> patch = rectangle ({0.0, 0.0, 0.0}, {0.001, 0.0, 0.0}, {0.0, 0.001, 0.0}, 2000);
  for (OrientedPoint& p : patch)
    p.position.z () = 0.0f;
  testing::internal::CaptureStderr ();
  testing::internal::CaptureStdout ();
  EXPECT_TRUE (findSupportPlanes (patch, boxOn ({0.0, 0.0, 0.0})).empty ());
  EXPECT_EQ (testing::internal::GetCapturedStdout (), "");
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "");
}
