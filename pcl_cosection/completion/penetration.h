// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief The largest depth of an object's surface in another body, metres; 0 if it is outside. Only the supported part
 * of the body counts.
 * \param[in] surface the object's solved field
 * \param[in] T_body_object poses of the object in the body's frame */
double penetration (const SignedDistanceField& surface, const SignedDistanceField& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object, int threads);

/** \brief The largest depth of an object's surface in given planes, the background and obstacles, metres. */
double penetrationOfSurroundings (const Scene& scene, const SceneObject& object, const SignedDistanceField& surface,
                                  const std::vector<SignedDistanceField::ConstPtr>& background,
                                  const std::vector<Obstacle>& obstacles);

} // namespace pcl::cosection
