// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Geometry>

#include <string>

namespace pcl::cosection {

/** \brief The pose of a 4 x 4 matrix. What rounding took from the rotation is given back. \throws IoError if it is not
 * finite, or not rigid */
PCL_COSECTION_EXPORT Eigen::Isometry3d poseOfMatrix (const Eigen::Matrix4d& matrix);

/** \brief Read a pose as 7-Scenes has it: the 16 numbers of a 4 x 4 matrix, row by row. \throws IoError if it cannot be
 * read, is not finite, or not rigid */
PCL_COSECTION_EXPORT Eigen::Isometry3d readPoseMatrix (const std::string& path);

} // namespace pcl::cosection
