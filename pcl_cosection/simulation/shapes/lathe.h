// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/simulation/simulated_scene.h>

namespace pcl::cosection {

/** \brief The surface that a profile (distance from the axis, z) leaves when it is turned about z.
 * \param[in] profile counter-clockwise (matter on the left, seen with z up and the axis on the left); its edges on the
 * axis are no surface
 * \param[in] closed whether the last point is joined to the first
 * \param[in] chord_m farthest that triangles may be from the surface */
TriangleMesh turnedProfile (const Polygon2d& profile, bool closed, double chord_m);

/** \brief Points of an arc about \a centre, ends included, no chord of which is farther from it than \a chord_m. */
Polygon2d arc (const Eigen::Vector2d& centre, double radius, double from_rad, double to_rad, double chord_m);

} // namespace pcl::cosection
