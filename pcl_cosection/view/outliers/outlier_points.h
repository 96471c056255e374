// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <vector>

namespace pcl::cosection {

/** \brief Which points belong to no patch of some size: a few points far from all others, as wrong readings and wrong
 * labels leave, which would each become a body of its own. Points count as near if they are within about
 * \a reach_m of each other.
 * \param[in] middle of most points, metres
 * \return one value per point */
std::vector<bool> findOutlierPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle,
                                     double reach_m);

} // namespace pcl::cosection
