// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "depth_grid.h"
#include "pcl_cosection/segmentation/planes/room_regions.h"

#include <vector>

namespace pcl::cosection {

/** \brief How the outline of a piece goes on in the image, in pixels. */
struct PieceOutline
{
  int free = 0; ///< what is seen beside it is farther away, or lower
  int held = 0; ///< it touches the room, on which it stands, or of which it is a part
  int edge = 0; ///< of these: it falls off behind the surface that it touches
};

/** \brief \param[in] piece_of one per pixel, -1 for none \param[in] pieces number of them */
std::vector<PieceOutline> outlinePieces (const DepthGrid& grid, const Room& room, const std::vector<int>& piece_of,
                                         std::size_t pieces);

} // namespace pcl::cosection
