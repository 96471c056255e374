// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support_surfaces.h"
#include "surface_patches.h"

#include <vector>

namespace pcl::cosection {

/** \brief The parts of a view that show the room and its furniture. */
struct Room
{
  std::vector<SupportSurface> surfaces; ///< best seen first
  std::vector<int> surface_of;          ///< one per pixel: the surface it is a part of; -1: none
};

/** \brief Finds the planes of a room, and how far each of them reaches in the image.
 *
 * A plane goes on beyond what it was found by: the front of a box may be as far away as the edge of a shelf, and is no
 * part of it. So the pixels on each plane are divided into connected regions (dividePlanes ()), of which are room
 * - those that are longer than an object, and the largest one, if it has \a min_area_m2;
 * - those that are enclosed: what is seen beside them rises before them, as it does around the back of a compartment
 *   and around what shows of a wall between things. The face of an object ends freely: what is seen beside it lies
 *   behind its plane. Only what is room itself encloses; what stands before a region may be anything;
 * - remainders of a surface of the room that something divides from it;
 * - what begins at a convex edge of the room: the end of a board. What stands on the room meets it at concave edges.
 *
 * No room is found unless a plane is seen well enough for normals: steep parts of a bowl are as flat as their noise
 * lets.
 *
 * Lengths in metres, areas in square metres. */
Room findRoom (const DepthGrid& grid, float max_object_size_m, float min_area_m2, int threads);

/** \brief One per patch: whether it is an edge of the room, as the front of a board or of a table top: it begins where
 * a surface of the room ends, and falls off behind it. What stands on a surface, or leans against it, is before it. */
std::vector<char> findRoomEdges (const DepthGrid& grid, const Room& room, const PatchImage& image);

} // namespace pcl::cosection
