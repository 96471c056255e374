// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A point in the frame of an open box: x and y along its walls, z upwards. */
struct BoxPoint
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

struct BoxOutline
{
  Eigen::Array2d middle;
  Eigen::Array2d half_sizes;
  std::size_t walls; // number of walls that were seen
};

/** \brief The outline of an open box: the outer sides of its walls, at half height. An unseen outer side is as far from
 * the inner side as other walls, or the floor, are thick.
 * \param[in] points relative to a middle near the origin, heights from the middle of the walls
 * \param[in] half_sizes approximate
 * \param[in] bottom height, if known
 * \return nothing if a wall is missing, or less than two were seen from inside */
std::optional<BoxOutline> outlineByWalls (const std::vector<BoxPoint>& points, const Eigen::Array2d& half_sizes,
                                          const std::optional<double>& bottom);

} // namespace pcl::cosection
