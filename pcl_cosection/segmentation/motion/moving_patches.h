// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/segmentation/geometry/surface_patches.h"

#include <vector>

namespace pcl::cosection {

/** \brief Patches that move, by what their pixels say and what they are joined to: the minimum of
 * sum_i a_i (x_i - y_i)^2 + sum_ij w_ij (x_i - x_j)^2, from which on x_i exceeds 1/2.
 * \param[in] votes one per pixel, from -1, it is plainly at rest, to 1
 * \param[in] borders of patches; what is not positive joins nothing
 * \return one per patch */
std::vector<char> movingPatches (const PatchImage& image, const std::vector<float>& votes,
                                 const PatchEvidence& borders);

/** \brief Numbers, from 1, of the connected parts of pixels that are set; 0: not set, or of a part of fewer than \a
 * min_pixels. */
std::vector<int> connectedParts (const DepthGrid& grid, const std::vector<char>& set, int min_pixels);

} // namespace pcl::cosection
