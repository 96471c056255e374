// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/body_parts.h"
#include "pcl_cosection/physics/scene_builder.h"

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

constexpr const char* background_name = "background";

/** \brief Add the background, if there is one, as a static body. What of it is not near the support planes, which are
 * bodies already, is divided by a grid into patches, of which each is as thick as a voxel and collides by its convex
 * hull. Where such a hull would overlap an object, it is cut.
 * \param[in] planes support planes, scene frame \param[in] objects what objects collide by, scene frame */
void addBackground (const CompletedScene& scene, const std::vector<Eigen::Vector4d>& planes,
                    const std::vector<BodyParts>& objects, PhysicalScene& result);

} // namespace pcl::cosection
