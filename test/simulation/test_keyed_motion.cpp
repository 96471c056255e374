// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

Eigen::Quaterniond
turn (double degrees, const Eigen::Vector3d& axis)
{
  return Eigen::Quaterniond (Eigen::AngleAxisd (degrees * M_PI / 180.0, axis.normalized ()));
}

} // namespace

TEST (KeyedVector, PassesItsKeysAndNeverLeavesThem)
{
  const std::vector<double> times{0.0, 1.0, 1.5, 4.0, 4.1, 6.0};
  const std::vector<Eigen::Vector3d> values{{0, 0, 0}, {1, 0, 5}, {1.1, 0, 5}, {-3, 2, 5}, {-3, 9, 4}, {0, 9, 4}};
  const KeyedVector path (times, values);
  for (std::size_t n = 0; n < times.size (); ++n)
    EXPECT_EQ (path.at (times[n]), values[n]);
  for (std::size_t n = 0; n + 1 < times.size (); ++n)
    for (int s = 0; s <= 100; ++s)
    {
      const Eigen::Vector3d p = path.at (times[n] + (times[n + 1] - times[n]) * s / 100.0);
      for (int c = 0; c < 3; ++c)
      {
        ASSERT_GE (p[c], std::min (values[n][c], values[n + 1][c]));
        ASSERT_LE (p[c], std::max (values[n][c], values[n + 1][c]));
      }
    }
  EXPECT_EQ (path.at (-5.0), values.front ());
  EXPECT_EQ (path.at (99.0), values.back ());
}

TEST (KeyedVector, WhatRestsStaysExactlyWhereItIs)
{
  const KeyedVector path ({0.0, 1.0, 2.0, 3.0}, {{0.1, 0.2, 0.3}, {0.7, 0.2, 0.3}, {0.7, 0.2, 0.3}, {0.7, 0.9, 0.3}});
  for (double t = 1.0; t <= 2.0; t += 0.01)
    ASSERT_EQ (path.at (t), Eigen::Vector3d (0.7, 0.2, 0.3));
}

TEST (KeyedVector, VelocityIsContinuous)
{
  const KeyedVector path ({0.0, 1.0, 1.5, 3.0}, {{0, 0, 0}, {1, 3, 0}, {2, 1, 0}, {4, 0, 2}});
  constexpr double h = 1e-6;
  for (const double t : {1.0, 1.5})
    EXPECT_LE (((path.at (t + h) - path.at (t)) - (path.at (t) - path.at (t - h))).norm () / h, 1e-3);
  EXPECT_GT ((path.at (1.0 + h) - path.at (1.0 - h)).x () / (2.0 * h), 0.5); // passes without a stop
}

TEST (KeyedRotation, TurnsAboutAFixedAxisAsAnAngle)
{
  const Eigen::Vector3d axis = Eigen::Vector3d (1, 2, -1).normalized ();
  const std::vector<double> times{0.0, 1.0, 2.0, 2.5, 4.0}, degrees{0.0, 100.0, 240.0, 240.0, 300.0};
  std::vector<Eigen::Quaterniond> values;
  std::vector<Eigen::Vector3d> angles;
  for (const double d : degrees)
  {
    values.push_back (turn (d, axis));
    angles.emplace_back (d, 0.0, 0.0);
  }
  const KeyedRotation rotation (times, values);
  const KeyedVector angle (times, angles);
  for (double t = -0.1; t < 4.2; t += 0.05)
    EXPECT_NEAR (rotation.at (t).angularDistance (turn (angle.at (t).x (), axis)), 0.0, 1e-6) << t;
}

TEST (KeyedRotation, IsSmoothAcrossKeysOfDifferentAxes)
{
  const std::vector<double> times{0.0, 1.0, 1.7, 3.0};
  const std::vector<Eigen::Quaterniond> values{turn (0, {1, 0, 0}), turn (50, {1, 0.5, 0.3}),
                                               turn (95, {0.8, 0.7, 0.5}), turn (140, {0.4, 1, 1})};
  const KeyedRotation rotation (times, values);
  constexpr double h = 1e-5;
  double speed = 0.0;
  for (std::size_t n = 0; n < times.size (); ++n)
  {
    EXPECT_LE (rotation.at (times[n]).angularDistance (values[n]), 1e-9);
    const Eigen::AngleAxisd before (rotation.at (times[n] - h).conjugate () * rotation.at (times[n]));
    const Eigen::AngleAxisd after (rotation.at (times[n]).conjugate () * rotation.at (times[n] + h));
    EXPECT_LE ((before.angle () * before.axis () - after.angle () * after.axis ()).norm () / h, 1e-3) << n;
    speed = std::max (speed, after.angle () / h);
  }
  EXPECT_GT (speed, 0.1); // somewhere it passes a key without stopping
}

TEST (KeyedRotation, TurnsNoFartherThanItsKeys)
{
  const std::vector<double> times{0.0, 0.2, 3.0, 3.1};
  const std::vector<Eigen::Quaterniond> values{turn (0, {0, 0, 1}), turn (80, {0, 0, 1}), turn (90, {0.1, 0, 1}),
                                               turn (170, {0.3, 0.2, 1})};
  const KeyedRotation rotation (times, values);
  for (std::size_t n = 0; n + 1 < times.size (); ++n)
  {
    const double whole = values[n].angularDistance (values[n + 1]);
    for (int s = 0; s <= 50; ++s)
      EXPECT_LE (values[n].angularDistance (rotation.at (times[n] + (times[n + 1] - times[n]) * s / 50.0)),
                 whole + 1e-9);
  }
}

TEST (KeyedMotion, LooksAtItsTarget)
{
  const KeyedMotion motion (KeyedVector ({0.0, 2.0}, {{1, 0, 1}, {0, 1, 1}}),
                            KeyedVector ({0.0, 2.0}, {{0, 0, 0}, {0, 0, 0.5}}), Eigen::Vector3d::UnitZ ());
  for (const double t : {0.0, 0.7, 2.0})
  {
    const Eigen::Isometry3d T = motion.at (t);
    const Eigen::Vector3d target = T.inverse () * Eigen::Vector3d (0, 0, 0.5 * (3 * t * t / 4.0 - 2 * t * t * t / 8.0));
    EXPECT_NEAR (target.head<2> ().norm (), 0.0, 1e-9);
    EXPECT_GT (target.z (), 0.0);
    EXPECT_LT (T.linear ().col (1).z (), 0.0); // y is down
    EXPECT_NEAR (T.linear ().determinant (), 1.0, 1e-12);
  }
}

TEST (KeyedMotion, WrongKeysAreRefused)
{
  const Eigen::Vector3d p (0, 0, 0);
  EXPECT_THROW (KeyedVector ({}, {}), InvalidArgument);
  EXPECT_THROW (KeyedVector ({0.0, 0.0}, {p, p}), InvalidArgument);
  EXPECT_THROW (KeyedVector ({1.0, 0.0}, {p, p}), InvalidArgument);
  EXPECT_THROW (KeyedVector ({0.0, std::nan ("")}, {p, p}), InvalidArgument);
  EXPECT_THROW (KeyedVector ({0.0}, {Eigen::Vector3d (0, INFINITY, 0)}), InvalidArgument);
  EXPECT_THROW (KeyedRotation ({0.0}, {Eigen::Quaterniond (0, 0, 0, 0)}), InvalidArgument);
  EXPECT_THROW (KeyedRotation ({0.0, 1.0}, {turn (0, {0, 0, 1}), turn (180, {0, 0, 1})}), InvalidArgument);
}
