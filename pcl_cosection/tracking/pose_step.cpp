// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pose_step.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

Eigen::Matrix3d
crossMatrix (const Eigen::Vector3d& v)
{
  Eigen::Matrix3d m;
  m << 0.0, -v.z (), v.y (), v.z (), 0.0, -v.x (), -v.y (), v.x (), 0.0;
  return m;
}

/** \brief Takes (t, scale omega) about \a center to (t', new_scale omega) about \a new_center: the same motion. */
PoseStep::Matrix6d
changeOfCenter (const Eigen::Vector3d& center, double scale, const Eigen::Vector3d& new_center, double new_scale)
{
  PoseStep::Matrix6d change = PoseStep::Matrix6d::Identity ();
  change.topRightCorner<3, 3> () = crossMatrix (center - new_center) / scale;
  change.bottomRightCorner<3, 3> () *= new_scale / scale;
  return change;
}

} // namespace

PoseStep::PoseStep (const ResidualSums& sums, const SampledVolume& volume, double min_observability)
    : min_observability_ (min_observability)
{
  Matrix6d squares;
  int entry = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      squares (row, column) = squares (column, row) = sums.squares[entry++];
  const Vector6d gradient = Eigen::Map<const Vector6d> (sums.gradient.data ());

  const double weight = std::max (sums.robust_weight, 1e-300);
  const Eigen::Vector3d lever = Eigen::Map<const Eigen::Vector3d> (sums.lever.data ()) / weight;
  const double spread = std::sqrt (std::max (0.0, sums.squared_lever / weight - lever.squaredNorm ()));
  centroid_ = volume.center () + volume.radius () * lever;
  radius_m_ = std::max (volume.radius () * spread, volume.voxel_size_m);

  const Matrix6d change = changeOfCenter (centroid_, radius_m_, volume.center (), volume.radius ());
  squares_ = change.transpose () * squares * change;
  gradient_ = change.transpose () * gradient;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (squares_);
  eigenvalues_ = solver.eigenvalues ().cwiseMax (0.0);
  directions_ = solver.eigenvectors ();
}

Eigen::Isometry3d
PoseStep::solve (double damping, double& length) const
{
  const Vector6d along = directions_.transpose () * gradient_;
  Vector6d step = Vector6d::Zero ();
  for (int n = 6 - observed (); n < 6; ++n)
    step -= along[n] / (eigenvalues_[n] + damping * eigenvalues_[5]) * directions_.col (n);
  length = step.norm ();

  const Eigen::Vector3d omega = step.tail<3> () / radius_m_;
  const double angle = omega.norm ();
  const Eigen::AngleAxisd turn (angle, angle > 0.0 ? Eigen::Vector3d (omega / angle) : Eigen::Vector3d::UnitX ());
  return Eigen::Translation3d (centroid_ + step.head<3> ()) * turn * Eigen::Translation3d (-centroid_);
}

PoseStep::Vector6d
PoseStep::observability () const
{
  return solvable () ? Vector6d (eigenvalues_ / eigenvalues_[5]) : Vector6d::Zero ();
}

int
PoseStep::observed () const
{
  if (!solvable ())
    return 0;
  return static_cast<int> (
      (eigenvalues_.array () >= min_observability_ * eigenvalues_[5] && eigenvalues_.array () > 0.0).count ());
}

PoseStep::Matrix6d
PoseStep::information () const
{
  const Matrix6d change = changeOfCenter (Eigen::Vector3d::Zero (), 1.0, centroid_, radius_m_);
  return change.transpose () * squares_ * change;
}

} // namespace pcl::cosection
