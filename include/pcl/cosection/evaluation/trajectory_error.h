// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief How the estimate is brought into the frame of the truth. */
enum class TrajectoryAlignment
{
  None,  ///< it is already
  First, ///< by the first poses that match
  Se3,   ///< by least squares of all positions, rotation and translation without scale
};

/** \brief How to compare trajectories. */
struct PCL_COSECTION_EXPORT TrajectoryOptions
{
  std::optional<double> max_difference_s; ///< of stamps that match; nothing: half the truth's median period
  TrajectoryAlignment alignment = TrajectoryAlignment::Se3; ///< of the estimate
  int delta = 1;                                            ///< of the relative pose error, in matched poses

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Two poses that belong to each other, by their indices. */
struct PosePair
{
  std::size_t truth = 0;    ///< index in the truth
  std::size_t estimate = 0; ///< index in the estimate
};

/** \brief The median difference of successive stamps; nothing of fewer than two poses. */
PCL_COSECTION_EXPORT std::optional<double> medianPeriod (const std::vector<StampedPose>& trajectory);

/** \brief Match poses one to one: the two nearest stamps first, then the two nearest of those that remain, up to
 * \a max_difference_s, it included. O (n log n).
 * \param[in] truth, estimate by ascending stamps
 * \param[in] max_difference_s seconds
 * \return by ascending stamps of the truth */
PCL_COSECTION_EXPORT std::vector<PosePair> associatePoses (const std::vector<StampedPose>& truth,
                                                           const std::vector<StampedPose>& estimate,
                                                           double max_difference_s);

/** \brief Errors of an estimated trajectory (J. Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems",
 * IROS 2012). */
struct PCL_COSECTION_EXPORT TrajectoryError
{
  std::size_t truth_poses = 0;    ///< number of them
  std::size_t estimate_poses = 0; ///< number of them
  std::size_t matched = 0;        ///< pairs of poses
  double max_difference_s = 0.0;  ///< of stamps that matched at most
  double truth_begin_s = 0.0;     ///< first stamp of the truth
  double truth_end_s = 0.0;       ///< last stamp of the truth
  double estimate_begin_s = 0.0;  ///< first stamp of the estimate
  double estimate_end_s = 0.0;    ///< last stamp of the estimate
  double largest_gap_s = 0.0;     ///< between successive matches
  double path_m = 0.0;            ///< length of the truth's path through the matches

  Eigen::Isometry3d T_truth_estimate = Eigen::Isometry3d::Identity (); ///< the alignment
  ErrorStatistics ate_m; ///< absolute trajectory error: distances of aligned positions

  std::size_t rpe_pairs = 0;    ///< that were compared
  std::size_t rpe_left_out = 0; ///< pairs of delta matches with a gap between them
  ErrorStatistics rpe_trans_m;  ///< relative pose error: of motions between matches that are delta apart
  ErrorStatistics rpe_rot_rad;  ///< their angles

  std::vector<std::string> notes; ///< what could not be determined
};

/** \brief Compare an estimated trajectory with the true one.
 *
 * ATE: |t_i - (S e_i)| for the positions t_i and e_i of matches and the alignment S. RPE: translation and angle of
 * (T_i^-1 T_j)^-1 (E_i^-1 E_j) for matches i and j = i + delta whose stamps differ by as much as those of most such
 * pairs, give or take half a period or 2 %: a motion over a gap is left out and counted.
 * \param[in] truth, estimate by ascending stamps
 * \param[in] options how to compare them
 * \throws InvalidArgument if an option is outside its domain
 * \throws DegenerateInput if a trajectory is empty, or no stamps match; the message has the spans of both */
PCL_COSECTION_EXPORT TrajectoryError compareTrajectories (const std::vector<StampedPose>& truth,
                                                          const std::vector<StampedPose>& estimate,
                                                          const TrajectoryOptions& options = {});

} // namespace pcl::cosection
