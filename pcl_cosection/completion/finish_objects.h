// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "background/background.h"
#include "pcl_cosection/energy/expected_error.h"
#include "surroundings.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief What the errors of an object's mesh depend on. */
std::vector<ErrorSources> errorSourcesOf (const SceneObject& object, const BodyEnergy& energy,
                                          const TriangleMesh& mesh);

/** \brief Fields, meshes with provenance, confidence and expected errors, bounds and penetration of all objects that
 * were solved.
 * \param[in] used_bytes memory in use, without obstacles and fields */
std::vector<ObjectResult> finishObjects (const Scene& scene, const std::vector<SceneObject>& objects,
                                         const std::vector<BodyEnergy>& energies,
                                         const std::vector<SignedDistanceField::ConstPtr>& background,
                                         const std::vector<Obstacle>& obstacles, UpdateOutput output,
                                         std::size_t used_bytes, CompletionLog& log);

/** \brief Remove the states of objects that failed. */
void dropFailed (const Scene& scene, const CompletionLog& log, SceneState& state);

/** \brief The results of all stages, in the form that users get. \a solvers and \a finished have a value per element of
 * \a objects, the others a value per object of the scene. */
SceneResult sceneResult (const Scene& scene, const std::vector<Observation>& observations,
                         const std::vector<SupportPlanes>& support, const std::vector<SceneObject>& objects,
                         const std::vector<double>& contradicted, Background background,
                         const std::vector<SolverSummary>& solvers, std::vector<ObjectResult> finished,
                         const CompletionLog& log);

} // namespace pcl::cosection
