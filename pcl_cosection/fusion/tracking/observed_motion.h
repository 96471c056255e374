// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_samples.h"

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief The part of a motion that the surface observes. */
struct ObservedMotion
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< of six, those that are observed
  /** \brief Along these, the inverse of the covariance of independent readings, in the coordinates of the samples'
   * chart, 1 / m^2. */
  Eigen::Matrix<double, 6, 6> precision = Eigen::Matrix<double, 6, 6>::Zero ();
};

/** \brief What is expected of a motion. */
struct MotionPrior
{
  double correlated = 0.0;    ///< points with the same error; 0: there are no errors, and every motion is significant
  double cost_of_turns = 1.0; ///< relative to shifts, where a surface observes only both together, as that of a ball
};

/** \brief Undo the part of a step along directions that the surface does not observe.
 *
 * Noise bends the distances before a bare wall, so that curvature alone claims that motion along the wall is observed.
 * A direction counts as observed only by points at which the distance changes along it at half its slope or more; fewer
 * are enough where the model has settled.
 *
 * A part that is not significant is undone, too: shorter than three of its standard deviations, by the spread of the
 * distances, it may be no motion at all. Otherwise weakly observed poses would follow noise and everything that moves.
 * \param[in] samples where the step ended, model frame
 * \param[in] guess T_model_camera where the step began
 * \param[in] found where it ended */
ObservedMotion observedMotion (const std::vector<SurfaceSample>& samples, const Eigen::Isometry3d& guess,
                               const Eigen::Isometry3d& found, const MotionPrior& prior);

} // namespace pcl::cosection
