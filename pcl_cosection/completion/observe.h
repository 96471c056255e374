// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion_log.h"
#include "pcl_cosection/priors/object_priors.h"
#include "scene.h"

#include <vector>

namespace pcl::cosection {

/** \brief The observation of each object, in the order of the scene; default values for objects that fail. Also updates
 * outliers and occlusion maps in the state. */
std::vector<Observation> observeObjects (const Scene& scene, CompletionMode mode, SceneState& state,
                                         CompletionLog& log);

} // namespace pcl::cosection
