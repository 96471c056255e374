// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Triangles of a polygon, maybe concave, by ear clipping (G. H. Meisters, 1975).
 *
 * The corners that may lie in an ear are found in a grid. Ears do not overlap, so all of them together look at about
 * n^1.5 cells.
 * \param[in] polygon its n corners, counter-clockwise
 * \return the indices of the corners of n - 2 triangles, counter-clockwise; none if the polygon crosses itself */
PCL_COSECTION_EXPORT std::vector<std::array<std::uint32_t, 3>> clipEars (const std::vector<Eigen::Vector2d>& polygon);

} // namespace pcl::cosection
