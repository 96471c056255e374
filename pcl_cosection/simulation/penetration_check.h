// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Two bodies of a scene that are inside each other at some time. */
struct ScenePenetration
{
  std::string first, second;
  double depth_m = 0.0; ///< deepest found
  int frame = 0;        ///< of the deepest
  int frames = 0;       ///< in how many
};

/** \brief How to look for bodies that penetrate each other. */
struct PenetrationCheckOptions
{
  double tolerance_m = 0.001; ///< what is still a contact; for meshes, whose distance is interpolated, at least a voxel
                              ///< of that
  int first = 0;              ///< frame
  int last = -1;              ///< frame, not looked at itself; -1: all from first on
  int threads = 0;            ///< 0: all
};

/** \brief Find bodies that penetrate each other: some thousand points on the surface of each, and its sharp edges all
 * along, are looked up in the distance of the other, in every frame in which their relative pose changed. A thing
 * thinner than the points are apart (a fiftieth of the size of a large flat body) may pass through a round one
 * unnoticed.
 * \throws Cancelled */
std::vector<ScenePenetration> findPenetrations (const SimulatedScene& scene,
                                                const PenetrationCheckOptions& options = {},
                                                const ProgressCallback& progress = {});

} // namespace pcl::cosection
