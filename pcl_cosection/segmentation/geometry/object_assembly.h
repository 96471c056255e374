// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "room_regions.h"
#include "surface_patches.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

namespace pcl::cosection {

constexpr int no_object = -1;
constexpr int too_long_object = -2;

/** \brief Joins pieces to objects, and drops the others. Joined are: fragments with what they touch most; parts that
 * are held from the side and stand on nothing; the inside of a hollow thing with its outside; pieces of one surface
 * that something nearer divides. Dropped are those that are too small, too large, above no support, or that hardly
 * stand out from the room.
 * \param[in,out] piece_of_patch one per patch: the piece it belongs to; then its object from 0, the largest in the
 * image first, or no_object, or too_long_object, what is an object but for its length
 * \return number of objects */
int assembleObjects (const DepthGrid& grid, const Room& room, const PatchImage& patches,
                     const ObjectSegmentationOptions& options, std::vector<int>& piece_of_patch);

} // namespace pcl::cosection
