// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief How far each brick of a block is from the nearest that is marked, in bricks, as a king moves: 0 for those, \a
 * max_distance at most.
 * \param[in] marked 1 or 0, row by row \param[in] dims bricks along each axis */
std::vector<std::uint8_t> brickDistances (std::vector<std::uint8_t> marked, const Eigen::Vector3i& dims,
                                          int max_distance);

} // namespace pcl::cosection
