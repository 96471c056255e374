// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief A point in the frame of an open box: along its walls, and upwards. */
struct BoxPoint
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

struct BoxOutline
{
  Eigen::Array2d middle;
  Eigen::Array2d half_sizes;
  std::size_t walls; // of which something was seen
};

/** \brief Where the outer sides of its walls are, halfway up: as they were seen, or else as far from their inner sides
 * as walls are thick, or its floor. \param[in] half_sizes about; the middle is near the origin, and heights are from
 * the middle of the walls \param[in] bottom height, if known
 * \return nothing if it lacks a wall, or but one was seen from inside */
std::optional<BoxOutline> outlineByWalls (const std::vector<BoxPoint>& points, const Eigen::Array2d& half_sizes,
                                          const std::optional<double>& bottom);

} // namespace pcl::cosection
