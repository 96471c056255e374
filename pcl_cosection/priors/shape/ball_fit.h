// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_axis.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

struct Ball
{
  Eigen::Vector3d center;
  double radius;
};

/** \brief Fit a ball to points.
 * \return nothing if they do not lie on a ball, face its inside, or cover too small a part of it */
std::optional<Ball> findBall (const std::vector<NormalLine>& lines);

/** \brief An axis of a ball about which a half turn takes its seen side to the hidden one. */
Axis axisOf (const Ball& ball, const std::vector<NormalLine>& lines);

} // namespace pcl::cosection
