// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection
{

struct Ball
{
  Eigen::Vector3d center;
  double radius;
};

/** \brief The ball whose surface the points are on.
 * \return nothing if they are not on a ball, inside it, or on too small a part of one */
std::optional<Ball> findBall (const std::vector<NormalLine>& lines);

/** \brief Of all axes of a ball one about which its seen side turns to the hidden one. */
Axis axisOf (const Ball& ball, const std::vector<NormalLine>& lines);

} // namespace pcl::cosection
