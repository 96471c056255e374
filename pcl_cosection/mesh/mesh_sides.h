// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/disjoint_sets.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <algorithm>
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
inline std::vector<Side>
sortedSides (const TriangleMesh& mesh)
{
  std::vector<Side> sides;
  sides.reserve (3 * mesh.triangles.size ());
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
    for (int n = 0; n < 3; ++n)
    {
      const std::uint64_t a = mesh.triangles[t][n];
      const std::uint64_t b = mesh.triangles[t][(n + 1) % 3];
      sides.push_back ({std::min (a, b) << 32 | std::max (a, b), static_cast<std::uint32_t> (t),
                        static_cast<std::uint8_t> (n), a < b});
    }
  std::sort (sides.begin (), sides.end (), [] (const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  });
  return sides;
}

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
inline void
uniteFans (const TriangleMesh& mesh, const Side& a, const Side& b, DisjointSets& corners)
{
  for (int end = 0; end < 2; ++end)
  {
    const int corner_a = (a.corner + end) % 3;
    int corner_b = b.corner;
    if (mesh.triangles[b.triangle][corner_b] != mesh.triangles[a.triangle][corner_a])
      corner_b = (b.corner + 1) % 3;
    corners.unite (3 * static_cast<std::size_t> (a.triangle) + corner_a,
                   3 * static_cast<std::size_t> (b.triangle) + corner_b);
  }
}

} // namespace pcl::cosection
