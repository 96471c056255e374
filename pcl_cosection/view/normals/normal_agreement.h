// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Share of pairs of neighbours whose normals contradict each other: one of them is flipped.
 *
 * On the two sides of a sheet normals oppose each other, too, but there each point is behind the other, or each before
 * it if all are flipped. Where most of the opposed ones are such pairs, none is counted.
 * \param[in] points finite \param[in] normals one per point; those that are not finite are left out */
double contradictingShare (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                           int neighbours = 6);

} // namespace pcl::cosection
