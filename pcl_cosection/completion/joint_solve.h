// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief Minimise the energies of all objects with the intersection constraint: they penetrate neither each other nor
 * their surroundings, equations (4) and (5).
 *
 * Passes over all objects are simultaneous: all bounds come from the fields of the pass before, so that the order of
 * objects has no influence. While an object is deeper in another body than allowed, the weight of this pair grows.
 * \param[in,out] energies one per object; the bounds of equation (5) are added. The solutions are in the objects'
 * states
 * \return one summary per object, with the iterations of all passes at full resolution */
std::vector<SolverSummary> solveJointly (const Scene& scene, const std::vector<SceneObject>& objects,
                                         const std::vector<SignedDistanceField::ConstPtr>& background,
                                         const std::vector<Obstacle>& obstacles, std::vector<BodyEnergy>& energies,
                                         CompletionLog& log);

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
