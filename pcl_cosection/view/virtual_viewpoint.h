// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Where the points of an object may have been seen from, if nothing is known of that: the direction to which
 * nearly all of them face, from far away. To judge how far hidden parts may reach, not to call space free.
 * \return nothing if there is no such direction, as for points from all around */
std::optional<DepthView> virtualViewpoint (const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
