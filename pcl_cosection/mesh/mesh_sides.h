// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/disjoint_sets.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Side n of a triangle runs from its corner n to corner n + 1. */
struct Side
{
  std::uint64_t edge; ///< both vertices, the smaller first
  std::uint32_t triangle;
  std::uint8_t corner;
  bool forward; ///< runs from the smaller to the larger vertex
};

/** \brief All sides of all triangles, those of one edge behind each other, by triangle. */
std::vector<Side> sortedSides (const TriangleMesh& mesh);

/** \brief Call \a body (begin, end) for the sides [begin, end) of every edge. */
template <typename Body>
void
forEachEdge (const std::vector<Side>& sides, Body&& body)
{
  for (std::size_t begin = 0, end = 0; begin < sides.size (); begin = end)
  {
    for (end = begin + 1; end < sides.size () && sides[end].edge == sides[begin].edge;)
      ++end;
    body (begin, end);
  }
}

/** \brief One side each way: the two triangles continue each other. */
inline bool
isManifoldEdge (const std::vector<Side>& sides, std::size_t begin, std::size_t end)
{
  return end - begin == 2 && sides[begin].forward != sides[begin + 1].forward;
}

/** \brief Group corners (three per triangle) into fans: two triangles of one edge belong together at both
 * of its vertices. */
void uniteFans (const TriangleMesh& mesh, const Side& a, const Side& b, DisjointSets& corners);

} // namespace pcl::cosection
