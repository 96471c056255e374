// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/completion/scene/completion_log.h"
#include "pcl_cosection/completion/scene/scene.h"
#include "pcl_cosection/completion/scene/scene_state.h"
#include "pcl_cosection/priors/observation.h"

#include <vector>

namespace pcl::cosection
{

/** \brief What was measured of each object, in the order of the scene, without outliers; default values for those that
 * fail. The state takes in which points are outliers, and what views hide of each object. */
std::vector<Observation> observeObjects (const Scene& scene, CompletionMode mode, SceneState& state,
                                         CompletionLog& log);

} // namespace pcl::cosection
