// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"

#include <optional>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief The upright axis of what is round as seen from above: of a plate, whose normals face sideways too little to tell.
 *
 * The circle that is nearest to the points farthest out (I. Kasa: A circle fitting procedure and its error analysis, IEEE Transactions on
 * Instrumentation and Measurement 25, 1976), if the points reach as far as it does in nearly all directions from its centre.
 * \param[in] up unit
 * \return nothing if they do not */
std::optional<Axis>
findFootprintAxis (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up);

} // namespace cosection
} // namespace pcl
