// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief A motion without what the surface does not tell of it. */
struct ObservedMotion
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< of six, those that are told
  int held = 0;       ///< of them, those in which the motion is within what noise would make of none
};

/** \brief Take back the part of a step in directions that no part of the surface opposes.
 *
 * Noise bends the distances before a bare wall everywhere a little, so that curvature alone says that its points know where they are along
 * it. A direction counts as told only by points at which the distance changes along it at half its slope or more.
 *
 * A part that is not significant is taken back, too: shorter than three of its standard deviations, by the spread of the distances, it may be
 * no motion at all. Otherwise poses that little holds would go with every noise, and with whatever else moves.
 * \param[in] points sensor frame, with \a weights
 * \param[in] guess where the step began
 * \param[in] found where it ended
 * \param[in] correlated how many points err together */
ObservedMotion
observedMotion (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights, const TsdfVolume& volume,
                const Eigen::Isometry3d& guess, const Eigen::Isometry3d& found, double correlated);

} // namespace cosection
} // namespace pcl
