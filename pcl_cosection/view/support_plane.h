// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Parameters of the search for support planes. */
struct SupportPlaneOptions
{
  double inlier_distance_m = 0.0; ///< 0: 5 % of the object's longest side
  double noise_m = 0.0;           ///< standard deviation of the points; 0: not known
  double reach = 0.5; ///< background within this fraction of the object's longest side, and within 36 noise_m, counts
  int min_inliers = 200;
  double min_inlier_share = 0.1; ///< of the background points in reach
  double max_below = 0.02;       ///< share of the object's points that may lie behind the plane
  int max_planes = 3;
};

/** \brief Planes of the background that an object stands on or leans against: fitted by RANSAC (PCL) to
 * the background points near the object, with all of the object on their free side. The normals of the background
 * points determine that side.
 * \return (n, d) with unit n towards free space and n.x + d = 0 on the plane; best supported first. The
 * result is the same every time. */
std::vector<Eigen::Vector4d> findSupportPlanes (const std::vector<OrientedPoint>& background,
                                                const std::vector<OrientedPoint>& object,
                                                const SupportPlaneOptions& options = {});

} // namespace pcl::cosection
