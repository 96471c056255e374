// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sdf_residuals.h"

#include <pcl/cosection/tracking/sdf_alignment.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief The normal equations of a pose, in coordinates in which its six directions are comparable: about the centroid
 * of the points, rotations in units of their root mean square distance from it. */
class PoseStep
{
public:
  using Vector6d = SdfAlignmentResult::Vector6d;
  using Matrix6d = SdfAlignmentResult::Matrix6d;

  /** \param[in] min_observability directions whose eigenvalue is a smaller fraction of the largest are held */
  PoseStep (const ResidualSums& sums, const SampledVolume& volume, double min_observability);

  /** \brief Whether any direction is determined. */
  bool solvable () const { return eigenvalues_[5] > 0.0; }

  /** \brief A Levenberg-Marquardt step: what takes the present pose to the next, from the left.
   * \param[in] damping as a fraction of the largest eigenvalue
   * \param[out] length root mean square of how far it moves the points, metres */
  Eigen::Isometry3d solve (double damping, double& length) const;

  /** \brief As SdfAlignmentResult::observability. */
  Vector6d observability () const;

  /** \brief Directions that are not held. */
  int observed () const;

  /** \brief As SdfAlignmentResult::information. */
  Matrix6d information () const;

private:
  Eigen::Vector3d centroid_; // grid frame
  double radius_m_;
  Matrix6d squares_; // in coordinates (t, radius * omega) about the centroid
  Vector6d gradient_;
  Vector6d eigenvalues_;
  Matrix6d directions_;
  double min_observability_;
};

} // namespace pcl::cosection
