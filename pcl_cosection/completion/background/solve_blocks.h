// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "background.h"

#include <vector>

namespace pcl::cosection {

/** \brief Solve a background in overlapping blocks, each with the fields of its neighbours as its boundary, until
 * neighbours agree at their seams (restricted multiplicative Schwarz method); the first fields are those of the whole
 * on coarser voxels. Only blocks whose evidence has changed are solved, and those that then disagree with them.
 * \param[in] points the measurements of the background
 * \param[in] coarse the field of the whole on coarser voxels, metres
 * \return a field per block, which meet without a gap, and one mesh of all
 * \throws Cancelled; what was solved is kept */
Background solveBlocks (const Scene& scene, CompletionMode mode, UpdateOutput output,
                        const std::vector<OrientedPoint>& points, const SignedDistanceField& coarse,
                        BackgroundBlocks& blocks, CompletionLog& log);

} // namespace pcl::cosection
