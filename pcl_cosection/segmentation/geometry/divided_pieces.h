// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_pieces.h"
#include "surface_patches.h"

#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Pairs of pieces that are one surface behind something nearer: most patches of the smaller one continue a
 * patch of the other one, as a plane or a round surface does, and all that is seen on the way between the two is in
 * front of them. */
std::vector<std::pair<int, int>> findDividedPieces (const DepthGrid& grid, const PatchImage& patches,
                                                    const std::vector<int>& piece_of_patch, const Borders& borders,
                                                    float max_object_size_m);

} // namespace pcl::cosection
