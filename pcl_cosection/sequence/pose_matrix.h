// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <string>

namespace pcl::cosection {

/** \brief Read a pose as 7-Scenes has it: the 16 numbers of a 4 x 4 matrix, row by row. What rounding took from the
 * rotation is given back. \throws IoError if it cannot be read, is not finite, or not rigid */
Eigen::Isometry3d readPoseMatrix (const std::string& path);

} // namespace pcl::cosection
