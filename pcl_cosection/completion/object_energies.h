// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief The energy of each object: data, hull and prior terms. An object without any measurement outside of seen free
 * space fails. */
std::vector<BodyEnergy> objectEnergies (const Scene& scene, CompletionMode mode,
                                        const std::vector<SceneObject>& objects, CompletionLog& log);

} // namespace pcl::cosection
