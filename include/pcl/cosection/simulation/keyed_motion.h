// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Geometry>

#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief Values at times, and between them a smooth curve that never leaves the range of the two values beside it.
 *
 * Each component is a cubic Hermite curve whose tangents are those of F. N. Fritsch and J. Butland, "A method for
 * constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 1984: zero where the values
 * turn or stay. Before the first and after the last time the value stays. */
class PCL_COSECTION_EXPORT KeyedVector
{
public:
  /** \throws InvalidArgument if there is no key, a position is not within a million metres, a time not within a billion
   * seconds, or the times do not grow by a microsecond at least. */
  KeyedVector (std::vector<double> times, std::vector<Eigen::Vector3d> values);

  Eigen::Vector3d at (double time) const;

private:
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> values_;
  std::vector<Eigen::Vector3d> tangents_; // per second
};

/** \brief Orientations at times, and between them a smooth turn that never turns farther than the two beside it.
 *
 * Between two keys the orientation is R_i exp (h (t)), where the components of the rotation vector h run from zero to
 * that of the shortest turn to the next key, monotone as KeyedVector's; the angular velocity is continuous. */
class PCL_COSECTION_EXPORT KeyedRotation
{
public:
  /** \throws InvalidArgument as KeyedVector, or if a turn is half a revolution or nearly so: its axis is not defined.
   */
  KeyedRotation (std::vector<double> times, std::vector<Eigen::Quaterniond> values);

  Eigen::Quaterniond at (double time) const;

private:
  std::vector<double> times_;
  std::vector<Eigen::Quaterniond> values_;
  std::vector<Eigen::Vector3d> turns_; // rotation vector from key i to i + 1, frame of key i
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rates_; // of h at the ends of turn i, per second
};

/** \brief How a body or a camera moves. */
class PCL_COSECTION_EXPORT KeyedMotion
{
public:
  /** \brief Stays where it is. */
  explicit KeyedMotion (const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity ());

  /** \brief Moves and turns. */
  KeyedMotion (KeyedVector position, KeyedRotation rotation);

  /** \brief Moves, and looks at a target that moves as well. */
  KeyedMotion (KeyedVector position, KeyedVector target, const Eigen::Vector3d& up);

  /** \brief Pose in the world at \a time, seconds. */
  Eigen::Isometry3d at (double time) const;

private:
  KeyedVector position_;
  std::optional<KeyedRotation> rotation_;
  std::optional<KeyedVector> target_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ ();
};

} // namespace pcl::cosection
