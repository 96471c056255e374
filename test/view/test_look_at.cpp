// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Poses of sensors that look at a point.

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <limits>

using namespace pcl::cosection;

namespace {

constexpr double rounding = 1e-12;
const Eigen::Vector3d eye (0.4, -1.2, 0.8), target (0.1, 0.3, -0.2);

void
expectPose (const Eigen::Isometry3d& T_world_sensor)
{
  EXPECT_EQ (T_world_sensor.translation (), eye);
  EXPECT_TRUE ((T_world_sensor.linear () * T_world_sensor.linear ().transpose ()).isIdentity (rounding));
  EXPECT_NEAR (T_world_sensor.linear ().determinant (), 1.0, rounding);
}

} // namespace

TEST (LookAt, TheTargetIsStraightAhead)
{
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d (0, 0, 1), Eigen::Vector3d (0, -3, 0.1), Eigen::Vector3d (0, 1e150, 0)})
  {
    const Eigen::Isometry3d T_world_sensor = lookAt (eye, target, up);
    expectPose (T_world_sensor);
    EXPECT_TRUE (
        (T_world_sensor.inverse () * target).isApprox (Eigen::Vector3d (0, 0, (target - eye).norm ()), rounding))
        << up;
    const Eigen::Vector3d direction = T_world_sensor.linear ().transpose () * up.stableNormalized ();
    EXPECT_NEAR (direction.x (), 0.0, rounding) << up;
    EXPECT_LT (direction.y (), 0.0) << up; // y is down
  }
}

TEST (LookAt, AlongUpAnyTurnWillDo)
{
  for (const double side : {-1.0, 1.0})
  {
    const Eigen::Isometry3d T_world_sensor = lookAt (eye, eye + side * Eigen::Vector3d::UnitZ ());
    expectPose (T_world_sensor);
    EXPECT_NEAR (T_world_sensor.linear () (2, 2), side, rounding);
  }
}

TEST (LookAt, WithoutADirectionThereIsNone)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN ();
  EXPECT_THROW (lookAt (eye, eye), InvalidArgument);
  EXPECT_THROW (lookAt (eye, {0, nan, 0}), InvalidArgument);
  EXPECT_THROW (lookAt (eye, target, {0, 0, 0}), InvalidArgument);
  EXPECT_THROW (lookAt (eye, target, {0, 0, nan}), InvalidArgument);
}
