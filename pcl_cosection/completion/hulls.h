// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief Add ObjectResult::hull and ObjectResult::outer_bound to the results of the objects, if the options ask for
 * them: the space that no view saw free.
 * \param[in] used_bytes memory in use, of that which the options allow
 * \param[in,out] results with meshes and fields, one per object */
void addHulls (const Scene& scene, const std::vector<SceneObject>& objects, std::size_t used_bytes,
               std::vector<ObjectResult>& results, CompletionLog& log);

} // namespace pcl::cosection
