// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief The vertical axis of what is round as seen from above: of a plate, whose normals face sideways too little to
 * tell.
 *
 * The circle that is nearest to the points farthest out (I. Kasa: A circle fitting procedure and its error analysis,
 * IEEE Transactions on Instrumentation and Measurement 25, 1976), if the points reach as far as it does in nearly all
 * directions from its centre.
 * \param[in] up unit
 * \return nothing if they do not */
std::optional<Axis> findFootprintAxis (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up);

/** \brief Indices of points that are farthest out in some direction each, as seen from above. */
std::vector<std::size_t> outermost (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up);

/** \brief Which way is up for what mostly faces one way, as the inside of a plate or bowl does: across the plane of its
 * rim, those of its points that are farthest out.
 * \return nothing if too little faces the same way */
std::optional<Eigen::Vector3d> rimNormal (const std::vector<NormalLine>& lines);

/** \brief Of the plane that is near most of the points; by reweighted least squares. \param[in] normal about, unit */
Eigen::Vector3d planeNormal (const std::vector<Eigen::Vector3d>& points, Eigen::Vector3d normal);

} // namespace pcl::cosection
