// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace pcl::cosection::marching_cubes {

/** \brief The surface inside a cell whose corners are inside or outside.
 *
 * Corner c is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4; bit 0 of e is its
 * position along the next axis (x -> y -> z -> x), bit 1 along the one after. */
struct Case
{
  static constexpr int max_triangles = 5;

  int triangle_count = 0;
  std::array<std::array<std::uint8_t, 3>, max_triangles>
      triangles{}; ///< the edges that carry the corners; outward orientation
};

using CaseTable = std::array<Case, 256>;

/** \brief The corner at which an edge begins; it ends at this corner plus the bit of its axis. */
constexpr int
edgeBegin (int edge)
{
  const int axis = edge / 4;
  return ((edge & 1) << ((axis + 1) % 3)) | (((edge >> 1) & 1) << ((axis + 2) % 3));
}

/** \brief Cases by the set of inside corners (bit c: corner c is inside).
 *
 * The table is derived, not typed: on each face of the cell, each run of inside corners is cut off
 * by one segment (so diagonal inside corners are separated), which depends on the face alone and is
 * the same for both cells of the face. The segments close to loops, each of which is triangulated
 * without a diagonal in a face of the cell, where it might coincide with one of the neighbour's.
 * (With the opposite rule, some loops would have no such triangulation.) */
const CaseTable& caseTable ();

} // namespace pcl::cosection::marching_cubes
