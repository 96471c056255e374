// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/body_parts.h"
#include "pcl_cosection/physics/scene_builder.h"

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

constexpr const char* background_name = "background";

/** \brief The vertices of the background that belong to no support plane, scene frame: of a block, a shelf, a wall.
 * \param[in] planes support planes, scene frame */
std::vector<Eigen::Vector3d> backgroundBesidePlanes (const CompletedScene& scene, const PhysicalScene& result,
                                                     const std::vector<Eigen::Vector4d>& planes);

/** \brief Whether a body touches a wall, or background that belongs to no support plane: it may lean there, or stand.
 * \param[in] planes support planes, scene frame \param[in] up unit
 * \param[in] background backgroundBesidePlanes () */
bool touchesSurroundings (const CollisionSource& source, const std::vector<Eigen::Vector4d>& planes,
                          const Eigen::Vector3d& up, const std::vector<Eigen::Vector3d>& background);

/** \brief Add the background, if there is one, as a static body. What of it is not near the support planes, which are
 * bodies already, is divided by a grid into patches, of which each is as thick as a voxel and collides by its convex
 * hull. Where such a hull would overlap an object, it is cut.
 * \param[in] planes support planes, scene frame \param[in] objects what objects collide by, scene frame */
void addBackground (const CompletedScene& scene, const std::vector<Eigen::Vector4d>& planes,
                    const std::vector<BodyParts>& objects, PhysicalScene& result);

} // namespace pcl::cosection
