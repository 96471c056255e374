// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "evaluation_meshes.h"

#include "pcl_cosection/evaluation/rigid_alignment.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/trajectory_error.h>

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Trajectory = std::vector<StampedPose>;

/** \brief A curve through space that also turns, a pose each 0.1 s. */
Trajectory
curve (std::size_t count)
{
  Trajectory poses;
  for (std::size_t n = 0; n < count; ++n)
  {
    const double t = 0.1 * static_cast<double> (n);
    poses.push_back ({t, motion (0.3 * t, {1.0, 2.0, 0.5}, {std::cos (t), std::sin (2.0 * t), 0.3 * t})});
  }
  return poses;
}

Trajectory
moved (Trajectory poses, const Eigen::Isometry3d& by)
{
  for (StampedPose& pose : poses)
    pose.pose = by * pose.pose;
  return poses;
}

const Eigen::Isometry3d elsewhere = motion (1.0, {0.2, -1.0, 0.4}, {3.0, -2.0, 1.0});

TrajectoryOptions
alignedBy (TrajectoryAlignment alignment)
{
  TrajectoryOptions options;
  options.alignment = alignment;
  return options;
}

} // namespace

TEST (TrajectoryError, AnotherWorldIsNoError)
{
  const Trajectory truth = curve (50);
  for (const auto alignment : {TrajectoryAlignment::Se3, TrajectoryAlignment::First})
  {
    const TrajectoryError error = compareTrajectories (truth, moved (truth, elsewhere), alignedBy (alignment));
    EXPECT_EQ (error.matched, 50u);
    EXPECT_LT (error.ate_m.max, 1e-9);
    EXPECT_LT (error.rpe_trans_m.max, 1e-9);
    EXPECT_LT (error.rpe_rot_rad.max, 1e-7);
    EXPECT_TRUE (error.T_truth_estimate.isApprox (elsewhere.inverse (), 1e-9));
    EXPECT_TRUE (error.notes.empty ());
  }
}

TEST (TrajectoryError, WithoutAlignmentTheOffsetIsTheError)
{
  const Trajectory truth = curve (20);
  const auto shift = motion (0.0, Eigen::Vector3d::UnitX (), {0.03, 0.0, 0.04});
  const TrajectoryError error = compareTrajectories (truth, moved (truth, shift),
                                                     alignedBy (TrajectoryAlignment::None));
  EXPECT_NEAR (error.ate_m.rmse, 0.05, 1e-12);
  EXPECT_NEAR (error.ate_m.median, 0.05, 1e-12);
  EXPECT_NEAR (error.ate_m.max, 0.05, 1e-12);
  EXPECT_NEAR (error.rpe_trans_m.rmse, 0.0, 1e-12);
}

TEST (TrajectoryError, KnownDriftIsTheRelativeError)
{
  // A straight path of 10 cm per pose; the estimate is 1 cm per pose too long, and turns by 0.01 radians more.
  Trajectory truth, estimate;
  for (int n = 0; n < 11; ++n)
  {
    truth.push_back ({1.0 * n, motion (0.0, Eigen::Vector3d::UnitX (), {0.1 * n, 0.0, 0.0})});
    estimate.push_back ({1.0 * n, motion (0.01 * n, Eigen::Vector3d::UnitX (), {0.11 * n, 0.0, 0.0})});
  }
  TrajectoryOptions options = alignedBy (TrajectoryAlignment::First);
  TrajectoryError error = compareTrajectories (truth, estimate, options);
  EXPECT_EQ (error.rpe_pairs, 10u);
  EXPECT_NEAR (error.rpe_trans_m.rmse, 0.01, 1e-12);
  EXPECT_NEAR (error.rpe_trans_m.max, 0.01, 1e-12);
  EXPECT_NEAR (error.rpe_rot_rad.rmse, 0.01, 1e-9);
  EXPECT_NEAR (error.ate_m.max, 0.1, 1e-12);
  EXPECT_NEAR (error.ate_m.median, 0.05, 1e-12);
  EXPECT_NEAR (error.path_m, 1.0, 1e-12);
  options.delta = 5;
  error = compareTrajectories (truth, estimate, options);
  EXPECT_EQ (error.rpe_pairs, 6u);
  EXPECT_NEAR (error.rpe_trans_m.mean, 0.05, 1e-12);
  EXPECT_NEAR (error.rpe_rot_rad.mean, 0.05, 1e-9);
}

TEST (TrajectoryError, AlignmentIsOfLeastSquares)
{
  // Four corners of a square, one of them 4 cm too high: the plane of least squares leaves 1 cm at each.
  Trajectory truth, estimate;
  const double x[] = {0.0, 1.0, 1.0, 0.0}, y[] = {0.0, 0.0, 1.0, 1.0};
  for (int n = 0; n < 4; ++n)
  {
    truth.push_back ({1.0 * n, motion (0.0, Eigen::Vector3d::UnitX (), {x[n], y[n], 0.0})});
    estimate.push_back (truth.back ());
  }
  estimate[2].pose.translation ().z () = 0.04;
  const TrajectoryError error = compareTrajectories (truth, moved (estimate, elsewhere));
  EXPECT_NEAR (error.ate_m.rmse, 0.01, 2e-4); // the tilt also shortens the sides a little
  EXPECT_NEAR (error.ate_m.max, 0.01, 5e-4);
}

TEST (TrajectoryError, StampsMatchWithinHalfAPeriod)
{
  const Trajectory truth = curve (50);
  Trajectory late = truth;
  for (StampedPose& pose : late)
    pose.stamp += 0.03;
  TrajectoryError error = compareTrajectories (truth, late);
  EXPECT_EQ (error.matched, 50u);
  EXPECT_LT (error.ate_m.max, 1e-9);
  EXPECT_NEAR (error.max_difference_s, 0.05, 1e-12);
  TrajectoryOptions strict;
  strict.max_difference_s = 0.01;
  const std::string message = messageOf<DegenerateInput> ([&] { compareTrajectories (truth, late, strict); });
  EXPECT_NE (message.find ("0 to 4.9"), std::string::npos) << message;
  EXPECT_NE (message.find ("0.03 to 4.93"), std::string::npos) << message;
}

TEST (TrajectoryError, GapsAreLeftOut)
{
  const Trajectory truth = curve (50);
  Trajectory estimate;
  for (std::size_t n = 5; n < 40; ++n)
    if (n < 20 || n >= 30)
      estimate.push_back (truth[n]);
  const TrajectoryError error = compareTrajectories (truth, moved (estimate, elsewhere));
  EXPECT_EQ (error.matched, 25u);
  EXPECT_EQ (error.estimate_poses, 25u);
  EXPECT_NEAR (error.largest_gap_s, 1.1, 1e-9);
  EXPECT_EQ (error.rpe_pairs, 23u);
  EXPECT_EQ (error.rpe_left_out, 1u);
  EXPECT_LT (error.ate_m.max, 1e-9);
}

TEST (TrajectoryError, ASparseEstimateHasAPeriodOfItsOwn)
{
  const Trajectory truth = curve (60);
  Trajectory estimate;
  for (std::size_t n = 0; n < 60; n += 3)
    estimate.push_back (truth[n]);
  const TrajectoryError error = compareTrajectories (truth, estimate);
  EXPECT_EQ (error.matched, 20u);
  EXPECT_EQ (error.rpe_pairs, 19u);
  EXPECT_EQ (error.rpe_left_out, 0u);
}

TEST (TrajectoryError, SaysWhatIsNotDetermined)
{
  const Trajectory truth = curve (3);
  const TrajectoryError two = compareTrajectories (truth, {truth[0], truth[1]});
  EXPECT_LT (two.ate_m.max, 1e-9);
  ASSERT_EQ (two.notes.size (), 1u);
  EXPECT_NE (two.notes[0].find ("fewer than three"), std::string::npos);
  EXPECT_EQ (two.rpe_pairs, 1u);

  const TrajectoryError one = compareTrajectories (truth, {truth[1]});
  EXPECT_EQ (one.ate_m.max, 0.0);
  EXPECT_EQ (one.rpe_pairs, 0u);
  EXPECT_EQ (one.notes.size (), 2u);

  Trajectory line, still;
  for (int n = 0; n < 5; ++n)
  {
    line.push_back ({1.0 * n, motion (0.1 * n, Eigen::Vector3d::UnitZ (), {0.1 * n, 0.2 * n, 0.0})});
    still.push_back ({1.0 * n, motion (0.1 * n, Eigen::Vector3d::UnitZ (), {1.0, 2.0, 3.0})});
  }
  for (const Trajectory& trajectory : {line, still})
  {
    const TrajectoryError error = compareTrajectories (trajectory, moved (trajectory, elsewhere));
    EXPECT_LT (error.ate_m.max, 1e-9);
    ASSERT_EQ (error.notes.size (), 1u);
    EXPECT_NE (error.notes[0].find ("not determined"), std::string::npos);
  }
}

TEST (TrajectoryError, RefusesNothing)
{
  EXPECT_THROW (compareTrajectories ({}, curve (3)), DegenerateInput);
  EXPECT_THROW (compareTrajectories (curve (3), {}), DegenerateInput);
  TrajectoryOptions options;
  options.delta = 0;
  EXPECT_THROW (compareTrajectories (curve (3), curve (3), options), InvalidArgument);
}

TEST (AssociatePoses, IsGreedyByDifference)
{
  // Against the definition: of all pairs that are left, the nearest, again and again.
  std::mt19937 generator (3);
  for (int round = 0; round < 50; ++round)
  {
    Trajectory a, b;
    double s = 0.0;
    for (int n = 0; n < 30; ++n)
      a.push_back ({s += 0.01 + static_cast<double> (generator () % 1000) * 1e-3, {}});
    s = 0.0037;
    for (int n = 0; n < 25; ++n)
      b.push_back ({s += 0.01 + static_cast<double> (generator () % 1000) * 1.1e-3, {}});
    constexpr double limit = 0.2;
    std::vector<int> expected (a.size (), -1);
    std::vector<bool> taken (b.size (), false);
    for (;;)
    {
      double least = limit;
      int best_a = -1, best_b = -1;
      for (std::size_t i = 0; i < a.size (); ++i)
        for (std::size_t j = 0; j < b.size (); ++j)
          if (expected[i] < 0 && !taken[j] && std::abs (a[i].stamp - b[j].stamp) < least)
          {
            least = std::abs (a[i].stamp - b[j].stamp);
            best_a = static_cast<int> (i);
            best_b = static_cast<int> (j);
          }
      if (best_a < 0)
        break;
      expected[static_cast<std::size_t> (best_a)] = best_b;
      taken[static_cast<std::size_t> (best_b)] = true;
    }
    std::vector<int> found (a.size (), -1);
    for (const PosePair& pair : associatePoses (a, b, limit))
      found[pair.truth] = static_cast<int> (pair.estimate);
    EXPECT_EQ (found, expected);
  }
}

TEST (MedianPose, IgnoresOutliers)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int n = -2; n <= 2; ++n)
    poses.push_back (motion (0.01 * n, Eigen::Vector3d::UnitZ (), {1.0 + 0.001 * n, 2.0, 3.0}));
  poses.push_back (motion (2.0, Eigen::Vector3d::UnitX (), {50.0, 2.0, 3.0}));
  poses.push_back (motion (-2.0, Eigen::Vector3d::UnitY (), {-50.0, 2.0, 3.0}));
  const Eigen::Isometry3d median = medianPose (poses);
  EXPECT_TRUE (median.isApprox (motion (0.0, Eigen::Vector3d::UnitZ (), {1.0, 2.0, 3.0}), 1e-9));
}

TEST (RefineAlignment, FindsASmallMotion)
{
  const TriangleMesh box = boxMesh ({-0.1f, -0.07f, -0.05f}, {0.1f, 0.07f, 0.05f});
  const Eigen::Isometry3d small = motion (0.03, {1.0, 2.0, 3.0}, {0.005, -0.004, 0.006});
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : sampleSurface (box, 3000))
    points.push_back (small * p);
  const Refinement result = refineAlignment (points, SurfaceDistance (box));
  EXPECT_FALSE (result.limited);
  EXPECT_TRUE ((result.correction * small).isApprox (Eigen::Isometry3d::Identity (), 1e-4));
  EXPECT_NEAR (result.rotation_rad, 0.03, 1e-3);
  EXPECT_LT (result.rmse_after_m, 1e-5);
  EXPECT_GT (result.rmse_before_m, 1e-3);
}

TEST (RefineAlignment, LeavesOutWhatIsNotDetermined)
{
  // A plane says nothing of motions along it.
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : sampleSurface (planeMesh (0.5, 2), 500))
    points.push_back (p + Eigen::Vector3d (0.25, 0.25, 0.008));
  const Refinement result = refineAlignment (points, SurfaceDistance (planeMesh (1.0, 4)));
  EXPECT_NEAR (result.correction.translation ().z (), -0.008, 1e-6);
  EXPECT_LT (result.correction.translation ().head<2> ().norm (), 1e-6);
  EXPECT_LT (result.rotation_rad, 1e-6);
}

TEST (RefineAlignment, StopsAtItsLimits)
{
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : sampleSurface (planeMesh (0.5, 2), 500))
    points.push_back (p + Eigen::Vector3d (0.25, 0.25, 0.015));
  RefinementOptions options;
  options.max_translation_m = 0.01;
  const Refinement result = refineAlignment (points, SurfaceDistance (planeMesh (1.0, 4)), options);
  EXPECT_TRUE (result.limited);
  EXPECT_LE (result.translation_m, 0.01);
}

TEST (TrajectoryError, TruthMayBeOfAnotherRate)
{
  // Motion capture at 100 Hz, an estimate at 30 Hz with one gap of a second.
  Trajectory truth, estimate;
  const auto at = [] (double t) { return motion (0.2 * t, Eigen::Vector3d::UnitZ (), {0.1 * t, 0.0, 0.0}); };
  for (int n = 0; n < 1000; ++n)
    truth.push_back ({0.01 * n, at (0.01 * n)});
  for (int n = 0; n < 290; ++n)
    if (n < 100 || n >= 130)
      estimate.push_back ({n / 30.0, at (n / 30.0)});
  for (const int delta : {1, 5, 10, 30})
  {
    TrajectoryOptions options;
    options.delta = delta;
    const TrajectoryError error = compareTrajectories (truth, estimate, options);
    EXPECT_EQ (error.matched, 260u);
    EXPECT_EQ (error.rpe_left_out, static_cast<std::size_t> (delta)) << delta;
    EXPECT_EQ (error.rpe_pairs, 260u - 2 * delta) << delta;
  }
}
