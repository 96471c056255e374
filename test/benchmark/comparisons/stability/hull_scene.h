// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace pcl::cosection::test {

/** \brief Points of the surface of each object, in the frame of the result. */
using SurfacePoints = std::map<int, std::vector<Eigen::Vector3f>>;

/** \brief Rigid bodies as one makes them without a reconstruction of the whole: the convex hull of each object's
 * points, as it is, of one density, at its place. What has no hull is left out.
 * \param[in] like the scene with the frame, gravity and planes of the result; nothing else of it is used */
PhysicalScene sceneOfHulls (const SurfacePoints& points, double density_kg_m3, const PhysicalScene& like);

} // namespace pcl::cosection::test
