// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Where something was at a time. */
struct StampedPose
{
  double stamp = 0.0;                                      ///< seconds, or the number of a frame or view
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity (); ///< metres
};

/** \brief Read a trajectory, a pose per line:
 * * as the TUM RGB-D benchmark has it, "stamp tx ty tz qx qy qz qw"; stamps of 16 or 19 digits are micro- or
 *   nanoseconds; quaternions are normalised
 * * as KITTI has it, the 12 or 16 numbers of a 3 x 4 or 4 x 4 matrix, row by row, a line for each frame
 *
 * Empty lines and lines that begin with # are skipped, and poses that are not finite, as where tracking was lost.
 * \param[in] path of the file
 * \param[in] frames stamps of the frames, ascending, for poses without one; empty: the n-th pose has stamp n, from 0
 * \return by ascending stamps
 * \throws IoError if the file cannot be read, has no pose, a line that cannot be read, a stamp twice, or poses without
 * a stamp, of another number than \a frames; the message names the line */
PCL_COSECTION_EXPORT std::vector<StampedPose> loadTrajectory (const std::string& path,
                                                              const std::vector<double>& frames = {});

/** \brief Write a trajectory in the format that loadTrajectory () reads; stamps that are whole numbers without a
 * decimal point. \throws IoError */
PCL_COSECTION_EXPORT void saveTrajectory (const std::vector<StampedPose>& poses, const std::string& path);

} // namespace pcl::cosection
