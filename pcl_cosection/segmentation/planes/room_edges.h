// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/segmentation/geometry/depth_grid.h"
#include "pcl_cosection/segmentation/geometry/surface_patches.h"
#include "room_regions.h"

#include <vector>

namespace pcl::cosection {

/** \brief One per patch: whether it is an edge of the room, as the front of a board or of a table top: it begins where
 * a surface of the room ends, and falls off behind it. What stands on a surface, or leans against it, is before it. */
std::vector<char> findRoomEdges (const DepthGrid& grid, const Room& room, const PatchImage& patches);

/** \brief Take patches out of the image. \param[in] gone one per patch */
void removePatches (PatchImage& patches, const std::vector<char>& gone);

} // namespace pcl::cosection
