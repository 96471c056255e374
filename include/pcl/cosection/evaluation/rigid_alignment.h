// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/surface_distance.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief A rigid motion, and whether the points determine it. */
struct PCL_COSECTION_EXPORT PointAlignment
{
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity ();
  bool determined = true; ///< false: the points are fewer than three, or on one line: rotations about it change nothing
};

/** \brief The rigid motion of least squared distances between corresponding points, without scale (B. K. P. Horn, JOSA
 * A 1987; S. Umeyama, TPAMI 1991). Of several that are as good, one of them; of no points the identity.
 * \throws InvalidArgument if there are not as many points of both */
PCL_COSECTION_EXPORT PointAlignment alignPoints (const std::vector<Eigen::Vector3d>& target,
                                                 const std::vector<Eigen::Vector3d>& source);

/** \brief A robust mean of poses: the rotation with the smallest sum of angles to all others (of the given ones), and
 * the translation that takes \a centre to the median, by coordinate, of where the poses take it. O (n^2).
 * \throws InvalidArgument if there are none */
PCL_COSECTION_EXPORT Eigen::Isometry3d medianPose (const std::vector<Eigen::Isometry3d>& poses,
                                                   const Eigen::Vector3d& centre = Eigen::Vector3d::Zero ());

/** \brief How far and how to refine. */
struct PCL_COSECTION_EXPORT RefinementOptions
{
  double max_distance_m = 0.02;    ///< farther points do not count
  double max_translation_m = 0.02; ///< of the centre of the points
  double max_rotation_rad = 0.1;
  int max_iterations = 50;
  int threads = 0; ///< 0: all

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief What a refinement did. */
struct PCL_COSECTION_EXPORT Refinement
{
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity (); ///< to be applied after the initial pose
  double translation_m = 0.0;                                    ///< of the centre of the points
  double rotation_rad = 0.0;
  double rmse_before_m = 0.0; ///< of the points that are near enough, to the surface
  double rmse_after_m = 0.0;
  bool limited = false; ///< a limit was reached; the last motion within it is the result
};

/** \brief Move points onto a surface: point-to-plane distances by Gauss-Newton (Y. Chen, G. Medioni, IVC 1992) with the
 * weights of Tukey, from a good start. Motions that the surface does not determine, as along a plane, are left out.
 * \param[in] points in the frame of the surface, near it; metres
 * \throws InvalidArgument if an option is outside its domain, or there are no points */
PCL_COSECTION_EXPORT Refinement refineAlignment (const std::vector<Eigen::Vector3d>& points,
                                                 const SurfaceDistance& surface, const RefinementOptions& options = {});

} // namespace pcl::cosection
