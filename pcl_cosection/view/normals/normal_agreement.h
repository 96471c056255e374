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

/** \brief How far normals are from those of the planes through their neighbours, where these are flat: the mean of the
 * squared sine of the angle, of any sign; 0 where too few are flat. Of random directions it is 2 / 3.
 * \param[in] points finite \param[in] normals one per point; those that are not finite are left out */
double slantOfNormals (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals);

} // namespace pcl::cosection
