// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Mean of positions, and their scatter matrix, the sum of (p - mean) (p - mean)^T. */
struct Scatter
{
  Eigen::Vector3d mean;
  Eigen::Matrix3d products;
};

Scatter scatterOf (const std::vector<OrientedPoint>& points);

/** \brief Principal axes of points as columns, independent of the points' frame; their senses are arbitrary. The last
 * axis is \a up, if given, otherwise the direction of least extent; the first one, orthogonal to it, is that of the
 * largest extent. */
Eigen::Matrix3d principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up);

} // namespace pcl::cosection
