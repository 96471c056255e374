// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection {

/** \brief Outer bounds of an object's shape as meshes in its frame; empty if not requested. */
struct HullMeshes
{
  TriangleMesh hull;
  TriangleMesh outer_bound;
};

/** \brief ObjectResult::hull and ObjectResult::outer_bound of each object: the space that no view saw free.
 * \param[in] meshes the closed meshes, \a fields the solved fields, one per object
 * \param[in] used_bytes memory in use, of that which the options allow */
std::vector<HullMeshes> findHulls (const Scene& scene, const std::vector<SceneObject>& objects,
                                   const std::vector<const TriangleMesh*>& meshes,
                                   const std::vector<const SignedDistanceField*>& fields, std::size_t used_bytes,
                                   CompletionLog& log);

} // namespace pcl::cosection
