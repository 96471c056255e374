// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_patches.h"

#include <map>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief What speaks for two patches being parts of one object, in pixels of their common border; negative: against
 * it. */
using PatchEvidence = std::map<std::pair<int, int>, float>;

/** \brief Evidence of all pairs of patches that touch: for, where they continue each other or meet at a convex edge,
 * against, where they meet at an edge that is concave by more than \a concave_angle_rad. */
PatchEvidence convexityEvidence (const DepthGrid& grid, const PatchImage& image, float concave_angle_rad);

/** \brief Greedy additive edge contraction: joins the two sets with the most evidence for it, adding up what their
 * members say about other sets, until none is left with evidence for it.
 * \return one per patch: the number of its set, from 0 */
std::vector<int> contractEdges (std::size_t patches, const PatchEvidence& evidence);

} // namespace pcl::cosection
