// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/convex_hull_mesh.h"

#include <Eigen/Core>

namespace pcl::cosection {

/** \brief How two convex bodies may be kept apart. */
struct Separation
{
  double depth_m = 0.0;                               ///< to be moved apart along the normal; negative: a gap
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ (); ///< from the first body to the second
  double offset = 0.0;                                ///< of the plane n.x = offset in the middle of the overlap
};

/** \brief The least overlap along the normals of the faces of both, and across two edges that may touch: the
 * penetration depth. Of hulls that are apart, a gap between them, which may be less than their distance.
 * O (edges x edges) if they overlap. */
Separation separationOf (const ConvexHull& first, const ConvexHull& second);

/** \brief What of a convex body lies behind a plane n.x + d = 0. */
ConvexHull cutBehind (const ConvexHull& hull, const Eigen::Vector4d& plane);

} // namespace pcl::cosection
