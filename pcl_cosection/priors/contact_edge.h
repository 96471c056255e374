// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "occlusion_map.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief The plane on which something stands, from where what was seen of it ends although sensors would have seen it
 * go on.
 *
 * What faces a sensor ends at its silhouette, where it turns away, at a sharp edge, where something hides it, or where
 * it touches what it stands on. If the lowest that was seen ends on one plane like that, with all else above it, that
 * is where it stands.
 * \param[in] points the object's
 * \param[in] views that saw it, and poses of their sensors, in the same frame
 * \return n.x + d = 0 with unit n towards the points; nothing if there is no such plane */
std::optional<Eigen::Vector4d> contactBoundaryPlane (const std::vector<OrientedPoint>& points,
                                                     const OcclusionMap::Views& views);

} // namespace pcl::cosection
