// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>

#include <vector>

namespace pcl::cosection {

/** \brief The penetration of every object that has a mesh and poses with every other and with the background, over all
 * frames of both. */
std::vector<PairPenetration> measurePenetrations (const SceneRecord& scene, double max_difference_s,
                                                  const RunOptions& options);

} // namespace pcl::cosection
