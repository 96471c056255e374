// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "surface_samples.h"

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief A motion without what the surface does not tell of it. */
struct ObservedMotion
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< of six, those that are told
  int held = 0;       ///< of them, those in which the motion is within what noise would make of none
  /** \brief Along directions that are told, the inverse of the covariance of independent readings, in the coordinates
   * of the samples' chart, 1 / m^2. */
  Eigen::Matrix<double, 6, 6> precision = Eigen::Matrix<double, 6, 6>::Zero ();
};

/** \brief What is expected of a motion. */
struct MotionPrior
{
  double correlated = 0.0;    ///< how many points err together; 0: they do not err, and every motion is significant
  double cost_of_turns = 1.0; ///< relative to that of shifts: where a surface tells only of both together, as a ball's
                              ///< does, the cheaper is taken
};

/** \brief Take back the part of a step in directions that no part of the surface opposes.
 *
 * Noise bends the distances before a bare wall everywhere a little, so that curvature alone says that its points know
 * where they are along it. A direction counts as told only by points at which the distance changes along it at half its
 * slope or more; fewer are enough where the model has settled.
 *
 * A part that is not significant is taken back, too: shorter than three of its standard deviations, by the spread of
 * the distances, it may be no motion at all. Otherwise poses that little holds would go with every noise, and with
 * whatever else moves.
 * \param[in] samples where the step ended, model frame
 * \param[in] guess T_model_camera where the step began
 * \param[in] found where it ended */
ObservedMotion observedMotion (const std::vector<SurfaceSample>& samples, const Eigen::Isometry3d& guess,
                               const Eigen::Isometry3d& found, const MotionPrior& prior);

} // namespace pcl::cosection
