// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "axes.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The vertical axis of a thing that is round as seen from above, such as a plate, whose normals hardly face
 * sideways and so determine no axis.
 *
 * It goes through the centre of a circle fitted to the outermost points (I. Kasa: A circle fitting procedure and its
 * error analysis, IEEE Transactions on Instrumentation and Measurement 25, 1976), if the points extend as far as the
 * circle in nearly all directions from its centre.
 * \param[in] up unit
 * \return nothing if they do not */
std::optional<Axis> findFootprintAxis (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up);

/** \brief Indices of the outermost points as seen from above, one per direction. */
std::vector<std::size_t> outermost (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up);

/** \brief The upward direction of a thing that mostly faces one way, as the inside of a plate or bowl does: the normal
 * of the plane through its rim, the outermost points.
 * \return nothing if the normals differ too much */
std::optional<Eigen::Vector3d> rimNormal (const std::vector<NormalLine>& lines);

/** \brief Normal of a plane fitted to most of the points, by reweighted least squares.
 * \param[in] normal first guess, unit */
Eigen::Vector3d planeNormal (const std::vector<Eigen::Vector3d>& points, Eigen::Vector3d normal);

} // namespace pcl::cosection
