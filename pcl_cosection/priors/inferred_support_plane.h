// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief The plane on which something open would stand of which hardly more than the inside was seen: a tray, a crate,
 * a bowl.
 *
 * Its rim lies over its floor all around. It ends at its lowest points; and under its floor it is taken to be as thick
 * as crockery is.
 * \return n.x + d = 0 with unit n upwards; nothing if it is not open */
std::optional<Eigen::Vector4d> inferredSupportPlane (const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
