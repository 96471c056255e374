// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>

#include <vector>

namespace pcl::cosection {

/** \brief The stamps at which each object of a scene is visible: it covers at least a thousandth of the picture, behind
 * others and the background. Without intrinsics, all stamps at which it and the camera have a pose. */
std::vector<std::vector<double>> visibleStamps (const SceneRecord& scene, double max_difference_s);

} // namespace pcl::cosection
