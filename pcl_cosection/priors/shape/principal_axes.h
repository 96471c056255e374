// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief Mean of positions, and the sum of the products of what they differ by from it. */
struct Scatter
{
  Eigen::Vector3d mean;
  Eigen::Matrix3d products;
};

Scatter scatterOf (const std::vector<OrientedPoint>& points);

/** \brief Axes, as columns, that turn with the points whatever frame they are in; either sense of each is as good. The
 * last is \a up, if given, else the direction in which the points extend least; the first that, across it, in which
 * they extend most. */
Eigen::Matrix3d principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up);

} // namespace pcl::cosection
