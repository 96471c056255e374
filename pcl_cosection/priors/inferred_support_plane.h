// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The support plane of an open thing that showed hardly more than its inside: a tray, a crate, a bowl.
 *
 * Its rim is higher than its floor all around. The plane is below its lowest points, and below the floor by the usual
 * thickness of crockery.
 * \return n.x + d = 0 with unit n upwards; nothing if the thing is not open */
std::optional<Eigen::Vector4d> inferredSupportPlane (const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
