// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/volume/signed_distance_field.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief How SdfAlignment looks for a pose. */
struct PCL_COSECTION_EXPORT SdfAlignmentOptions
{
  /** \brief Distances beyond which a point counts linearly (Huber's function), metres; 0: a fifth of the truncation
   * distance of a TSDF, two voxels of another field. */
  double huber_m = 0.0;
  double max_distance_m = 0.0; ///< points farther from the surface say nothing; 0: all speak
  int max_iterations = 40;     ///< steps tried, of all levels together
  int levels = 3;              ///< each uses four times as many points as the one before, the last one all of them
  int min_level_points = 2000; ///< a level of fewer points is left out, unless it is the last
  int max_points = 0;          ///< a sample of so many is used, evenly drawn; 0: all
  double tolerance_vox = 1e-3; ///< a step that moves the points by less, in voxels, is the last
  /** \brief Directions in the space of poses along which the sum of squares curves less than this fraction of the
   * strongest stay as they are (see SdfAlignmentResult::observability). */
  double min_observability = 1e-3;
  int min_points = 20; ///< with a distance; fewer determine no pose
  int threads = 0;     ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Why SdfAlignment ended. */
enum class SdfAlignmentStop
{
  Converged,     ///< the last step was shorter than the tolerance
  MaxIterations, ///< the pose still moved
  TooFewPoints,  ///< fewer points than asked for have a distance; the pose is the last at which enough had one
  NoGradient,    ///< no point says where to go: all are where distances are truncated, for instance
};

/** \brief One line for a user, such as "too few points have a distance". */
PCL_COSECTION_EXPORT const char* describe (SdfAlignmentStop stop);

/** \brief What SdfAlignment found. */
struct PCL_COSECTION_EXPORT SdfAlignmentResult
{
  /** \brief Translation first, then rotation. */
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  /** \brief Translation first, then rotation. */
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  Eigen::Isometry3d T_grid_sensor = Eigen::Isometry3d::Identity (); ///< the pose, metres
  bool converged = false;                                           ///< stop is Converged
  SdfAlignmentStop stop = SdfAlignmentStop::TooFewPoints;           ///< why it ended
  int iterations = 0;                                               ///< steps tried

  std::size_t points = 0;               ///< finite, of positive weight, and drawn
  std::size_t points_with_distance = 0; ///< of them: within the volume, where it has been seen
  double inlier_share = 0.0;            ///< share of the weight of points with a distance that is within Huber's bound
  double rms_m = 0.0;                   ///< root mean square of the distances, weighted, without Huber's weights

  /** \brief Sum of w J^T J at the pose; w: Huber's weight times the point's times the voxel's (1 at the volume's
   * largest). J is the derivative by (t, omega) of the distance at p + t + omega x p, with p = T_grid_sensor * point:
   * translation first, metres and radians, about the origin of the grid's frame. Divided by the variance of a distance
   * it is the inverse of the pose's covariance. */
  Matrix6d information = Matrix6d::Zero ();

  /** \brief Eigenvalues of the same matrix about the centroid of the points, with rotations in units of their root mean
   * square distance from it, divided by the largest; ascending. A bare plane has three that vanish, and so has a
   * sphere. */
  Vector6d observability = Vector6d::Zero ();
  int observed_directions = 0; ///< of six, those that were not held
};

/** \brief What points are aligned with. It refers to the volume, which must live as long. */
class PCL_COSECTION_EXPORT SdfTarget
{
public:
  /** \brief Voxels without weight say nothing, others in proportion to their weight. */
  SdfTarget (const TsdfVolume& volume); // NOLINT: conversion is its purpose

  /** \brief Voxels that are not supported say nothing. \throws InvalidArgument if the field is empty or has not one
   * value per voxel */
  SdfTarget (const SignedDistanceField& field); // NOLINT: conversion is its purpose

  /** \brief Distances; those without weight or support say nothing. */
  const SignedDistanceField& field () const { return *field_; }

  /** \brief One per voxel; null: all are 1. */
  const std::vector<float>* weights () const { return weights_; }

  /** \brief The largest weight that a voxel may have. */
  double maxWeight () const { return max_weight_; }

  /** \brief Default of SdfAlignmentOptions::huber_m. */
  double huber () const { return huber_m_; }

private:
  const SignedDistanceField* field_;
  const std::vector<float>* weights_ = nullptr;
  double max_weight_ = 1.0;
  double huber_m_;
};

/** \brief Finds the pose at which points lie on the surface of a signed distance volume, from a pose nearby: it
 * minimises
 *
 *     E(T) = sum_i w_i rho (d (T p_i))
 *
 * by the Levenberg-Marquardt method on SE(3), where d is the trilinear distance, rho Huber's function, and w_i the
 * weight of the point times that of the voxel it is in. No correspondences are looked for, and no normals are needed.
 * Points outside the volume, or where it knows nothing, have no part; a step counts as an improvement if it is one for
 * the points that had a distance before and have one after it.
 *
 * E. Bylow, J. Sturm, C. Kerl, F. Kahl, D. Cremers, "Real-Time Camera Tracking and 3D Reconstruction Using Signed
 * Distance Functions", RSS 2013; with robust and soft assignments as in M. Strecke, J. Stueckler, "EM-Fusion: Dynamic
 * Object-Level SLAM with Probabilistic Data Association", ICCV 2019. Directions that the geometry leaves open are held:
 * J. Zhang, M. Kaess, S. Singh, "On Degeneracy of Optimization-Based State Estimation Problems", ICRA 2016.
 *
 * O (points) per step, in parallel; a first part of the steps uses a sixteenth and a fourth of the points. The object
 * keeps its buffers: use one for all frames. Not for two threads at once.
 *
 * \code
 * SdfAlignment alignment;
 * for (const auto& frame : frames)
 * {
 *   const SdfAlignmentResult result = alignment.align (frame.points, frame.weights, volume, T_grid_sensor);
 *   if (result.converged)
 *     T_grid_sensor = result.T_grid_sensor;
 * }
 * \endcode */
class PCL_COSECTION_EXPORT SdfAlignment
{
public:
  /** \brief Empty buffers. \throws InvalidArgument as SdfAlignmentOptions::validate () */
  explicit SdfAlignment (const SdfAlignmentOptions& options = {});
  ~SdfAlignment ();
  /** \brief Takes over what the other one has. */
  SdfAlignment (SdfAlignment&& other) noexcept;
  /** \brief Takes over what the other one has. */
  SdfAlignment& operator= (SdfAlignment&& other) noexcept;

  /** \brief The options of the constructor. */
  const SdfAlignmentOptions& options () const;

  /** \brief Find the pose.
   * \param[in] points metres, sensor frame; those that are not finite are left out
   * \param[in] weights one per point, or none: 1; what is not positive and finite counts as 0
   * \param[in] target the volume
   * \param[in] guess T_grid_sensor to begin with, metres
   * \throws InvalidArgument if there is not one weight per point, the guess is not a finite rigid motion, or the volume
   * has more voxels than an int can count. Points that determine no pose are no error: see SdfAlignmentResult::stop. */
  SdfAlignmentResult align (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                            const SdfTarget& target, const Eigen::Isometry3d& guess = Eigen::Isometry3d::Identity ());

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** \brief The volume, options and last result of SdfRegistration and SdfTracker, which do not depend on the type of
 * their points.
 *
 * A setter that cannot use what it gets says why through PCL's console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT SdfAlignmentBase
{
public:
  /** \brief Set all parameters at once. */
  bool setOptions (const SdfAlignmentOptions& options);

  /** \brief The parameters, as setOptions () and setNumberOfThreads () left them. */
  const SdfAlignmentOptions& getOptions () const { return options_; }

  /** \brief Set the number of threads; 0 (default): all processors. The result does not depend on it. */
  void setNumberOfThreads (unsigned int threads = 0);

  /** \brief Why the last alignment ended, how well points fit, and which directions they determine. */
  const SdfAlignmentResult& getAlignment () const { return result_; }

protected:
  /** \param[in] name of the class, for messages: "cosection::SdfTracker" */
  explicit SdfAlignmentBase (const char* name) : name_ (name) {}

  ~SdfAlignmentBase () = default;

  /** \brief Set a volume as the target; where \a surface is not null, it must have a surface, and points on it are
   * returned there. \return false, with a message, if the volume is null or has no surface although it must */
  bool setTarget (const TsdfVolume::ConstPtr& volume, std::vector<Eigen::Vector3f>* surface = nullptr);

  /** \brief Set another field as the target; \a surface as for a volume. \return false, with a message, if the field is
   * null, has not one value per voxel, or has no surface although it must */
  bool setTarget (const SignedDistanceField::ConstPtr& field, std::vector<Eigen::Vector3f>* surface = nullptr);

  /** \brief Whether there is a target. */
  bool hasTarget () const { return volume_ || field_; }

  /** \brief What was set as the target. */
  SdfTarget target () const { return volume_ ? SdfTarget (*volume_) : SdfTarget (*field_); }

  /** \brief Fill the result by SdfAlignment::align (). \return false, with a message, if there is no target, or the
   * input or an option is not valid; the result is empty then */
  bool alignPoints (const SdfAlignmentOptions& options, const std::vector<Eigen::Vector3f>& points,
                    const std::vector<float>& weights, const Eigen::Isometry3d& guess);

  /** \brief Say what is wrong, through PCL's console. */
  void report (const char* function, const std::string& error) const;

  SdfAlignmentResult result_; ///< of the last alignment

private:
  const char* name_;
  SdfAlignmentOptions options_;
  TsdfVolume::ConstPtr volume_;
  SignedDistanceField::ConstPtr field_;
};

} // namespace pcl::cosection
