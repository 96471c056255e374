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

/** \brief Read a trajectory in the format of the TUM RGB-D benchmark: a line "stamp tx ty tz qx qy qz qw" per pose;
 * empty lines and lines that begin with # are skipped. Quaternions are normalised.
 * \return by ascending stamps
 * \throws IoError if the file cannot be read, has no pose, a line that cannot be read, or a stamp twice; the message
 * names the line */
PCL_COSECTION_EXPORT std::vector<StampedPose> loadTrajectory (const std::string& path);

/** \brief Write a trajectory in the format that loadTrajectory () reads; stamps that are whole numbers without a
 * decimal point. \throws IoError */
PCL_COSECTION_EXPORT void saveTrajectory (const std::vector<StampedPose>& poses, const std::string& path);

} // namespace pcl::cosection
