// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Two bodies of a scene that are inside each other at some time. */
struct PCL_COSECTION_EXPORT ScenePenetration
{
  std::string first, second;
  double depth_m = 0.0; ///< deepest found
  int frame = 0;        ///< of the deepest
  int frames = 0;       ///< in how many
};

/** \brief Find bodies that penetrate each other: points of the surface of each are looked up in the distance of the other, in
 * every frame in which their relative pose changed.
 * \param[in] tolerance_m what is still a contact; for meshes, whose distance is interpolated, at least a voxel of that
 * \param[in] threads 0: all */
PCL_COSECTION_EXPORT std::vector<ScenePenetration>
findPenetrations (const SimulatedScene& scene, double tolerance_m = 0.001, int threads = 0);

} // namespace cosection
} // namespace pcl
