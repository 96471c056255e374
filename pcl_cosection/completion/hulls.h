// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "surroundings.h"

#include <vector>

namespace pcl::cosection
{

/** \brief Bounds of an object's shape as meshes; empty where they were not asked for. Object frame. */
struct HullMeshes
{
  TriangleMesh hull;
  TriangleMesh outer_bound;
};

/** \brief What no view saw free, for each object: ObjectResult::hull and ObjectResult::outer_bound.
 * \param[in] meshes the closed meshes, \a fields the solved fields, one per object
 * \param[in] used_bytes of the memory that is allowed */
std::vector<HullMeshes> findHulls (const Scene& scene, const std::vector<SceneObject>& objects,
                                   const std::vector<const TriangleMesh*>& meshes,
                                   const std::vector<const SignedDistanceField*>& fields, std::size_t used_bytes,
                                   CompletionLog& log);

} // namespace pcl::cosection
