// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "background/background.h"
#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief Add the points and views that are new in the scene to the evidence of all bodies: equation (2), and the votes
 * on free space of equation (3). Warns of views that contradict an object's points.
 * \param[in,out] background its bodies; gets the points at rest
 * \return ObjectResult::contradicted_share of each object of the scene */
std::vector<double> gatherEvidence (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects,
                                    BackgroundBodies& background, CompletionLog& log);

/** \brief The energy of each object: data, hull and prior terms. An object without any measurement outside of seen free
 * space fails. */
std::vector<BodyEnergy> objectEnergies (const Scene& scene, CompletionMode mode,
                                        const std::vector<SceneObject>& objects, CompletionLog& log);

} // namespace pcl::cosection
