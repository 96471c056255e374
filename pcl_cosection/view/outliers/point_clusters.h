// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief Which points belong to no patch of some size: a few points far from all others, as wrong readings and wrong
 * labels leave, which would each become a body of its own. Points count as near if they are within about
 * \a reach_m of each other.
 * \param[in] middle of most points, metres
 * \return one value per point */
std::vector<bool> findOutlierPoints (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& middle,
                                     double reach_m);

/** \brief How far groups of points are apart that are each smaller than that: those of one thing at two places.
 * \param[in] box of the points
 * \return metres; 0 if there are no such groups of a twentieth of the points at least */
double gapBetweenGroups (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box);

/** \brief Where points were taken away, take what is left of the same thing as well: patches that are connected over
 * cells of \a cell_m, and have fewer points than were taken from their cells and those beside. O (points).
 * \param[in,out] taken by point */
void addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken);

} // namespace pcl::cosection
