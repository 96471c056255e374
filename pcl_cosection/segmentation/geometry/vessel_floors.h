// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "room_regions.h"

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Gives the floors of plates and open boxes, which lie so near to what they stand on that noise does not tell
 * them apart pixel by pixel, to the objects around them. A floor is a part of a surface of the room that objects divide
 * from the rest, and that is on average higher than the surface around.
 * \param[in,out] labels one per pixel: 0 no object, 1 ... objects */
void labelVesselFloors (const DepthGrid& grid, const Room& room, std::vector<std::uint32_t>& labels);

} // namespace pcl::cosection
