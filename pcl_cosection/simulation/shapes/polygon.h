// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/simulation/simulated_scene.h>

#include <vector>

namespace pcl::cosection {

/** \brief Points of an arc about \a centre, ends included, no chord of which is farther from it than \a chord_m. */
Polygon2d arc (const Eigen::Vector2d& centre, double radius, double from_rad, double to_rad, double chord_m);

/** \brief Counter-clockwise, checked. \throws InvalidArgument naming \a what if it is no simple polygon with an area.
 */
Polygon2d simplePolygon (Polygon2d polygon, const char* what);

/** \brief Signed distance of \a p, negative inside.
 * \param[in] open_at_axis edges with x = 0 at both ends are no boundary (the axis of a profile) */
double polygonDistance (const Polygon2d& polygon, const Eigen::Vector2d& p, bool open_at_axis = false);

} // namespace pcl::cosection
