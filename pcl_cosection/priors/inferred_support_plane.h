// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "occlusion_map.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The contact boundary plane: the plane at which the observed surface of an object ends although its sensors
 * would have seen it continue.
 *
 * A surface that faces a sensor ends at a silhouette, at a sharp edge, where something hides it, or where it touches
 * the support. If the lowest observed surface ends on one plane for no other reason, and all points lie above this
 * plane, it is the support plane.
 * \param[in] points of the object
 * \param[in] views of the object, and their sensors' poses in the points' frame
 * \return n.x + d = 0 with unit n towards the points; nothing if there is no such plane */
std::optional<Eigen::Vector4d> contactBoundaryPlane (const std::vector<OrientedPoint>& points,
                                                     const OcclusionMap::Views& views);

} // namespace pcl::cosection
