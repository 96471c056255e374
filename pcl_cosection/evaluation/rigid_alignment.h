// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief A rigid motion, and whether the points determine it. */
struct PointAlignment
{
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity ();
  bool determined = true; ///< false: the points are fewer than three, or on one line: rotations about it change nothing
};

/** \brief The rigid motion of least squared distances between corresponding points, without scale (B. K. P. Horn, JOSA
 * A 1987; S. Umeyama, TPAMI 1991). Of several that are as good, one of them; of no points the identity.
 * \throws InvalidArgument if there are not as many points of both */
PointAlignment alignPoints (const std::vector<Eigen::Vector3d>& target, const std::vector<Eigen::Vector3d>& source);

/** \brief A robust mean of poses: the rotation with the smallest sum of angles to all others (of the given ones), and
 * the translation that takes \a centre to the median, by coordinate, of where the poses take it. O (n^2).
 * \throws InvalidArgument if there are none */
Eigen::Isometry3d medianPose (const std::vector<Eigen::Isometry3d>& poses,
                              const Eigen::Vector3d& centre = Eigen::Vector3d::Zero ());

/** \brief Move points onto a surface: point-to-plane distances by Gauss-Newton (Y. Chen, G. Medioni, IVC 1992) with the
 * weights of Tukey, from a good start. Motions that the surface does not determine, as along a plane, are left out.
 * \param[in] points in the frame of the surface, near it; metres
 * \throws InvalidArgument if an option is outside its domain, or there are no points */
Refinement refineAlignment (const std::vector<Eigen::Vector3d>& points, const SurfaceDistance& surface,
                            const RefinementOptions& options = {});

} // namespace pcl::cosection
