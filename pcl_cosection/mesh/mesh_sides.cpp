// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_sides.h"

#include <algorithm>

namespace pcl::cosection {

std::vector<Side>
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

void
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
