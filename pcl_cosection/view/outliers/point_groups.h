// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief How far groups of points are apart that are each smaller than that: those of one thing at two places.
 * \param[in] box of the points
 * \return metres; 0 if there are no such groups of a twentieth of the points at least */
double gapBetweenGroups (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box);

} // namespace pcl::cosection
