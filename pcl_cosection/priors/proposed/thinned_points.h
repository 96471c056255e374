// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Positions with normals, one per column. */
struct OrientedColumns
{
  Eigen::Matrix3Xd positions, normals;

  /** \brief About \a count of them, evenly. */
  OrientedColumns few (Eigen::Index count) const;

  Eigen::Index size () const { return positions.cols (); }
};

/** \brief Distance between thinned points at which they show the shape of what all of them are on. */
double thinnedSpacing (const std::vector<OrientedPoint>& points);

/** \brief One point per occupied cell, the means of position and normal: it counts for as much surface as any other.
 */
OrientedColumns thinToCells (const std::vector<OrientedPoint>& points, double cell_m);

/** \brief Root mean square distance from the mean. */
double spreadOf (const Eigen::Matrix3Xd& positions);

} // namespace pcl::cosection
