// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.h"

namespace pcl::cosection {

/** \brief The method: complete all objects of a scene and the background they stand on.
 * \param[in,out] state incremental state: from the last update to the next, empty at first. It stays consistent with
 * the scene if this is cancelled
 * \throws Cancelled */
SceneResult completeScene (const Scene& scene, CompletionMode mode, UpdateOutput output,
                           const ProgressCallback& progress, SceneState& state);

} // namespace pcl::cosection
