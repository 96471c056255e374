// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "disjoint_sets.h"
#include "mesh_checks.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <algorithm>

namespace pcl
{
namespace cosection
{
namespace
{

/** \brief Side n of a triangle runs from its corner n to corner n + 1. */
struct Side
{
  std::uint64_t edge; ///< both vertices, the smaller first
  std::uint32_t triangle;
  std::uint8_t corner;
  bool forward; ///< runs from the smaller to the larger vertex
};

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

/** \brief Corners (three per triangle) grouped into fans: two triangles of one edge belong together
 * at both of its vertices. */
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

DisjointSets
connectedVertices (const TriangleMesh& mesh)
{
  DisjointSets sets (mesh.vertices.size ());
  for (const auto& triangle : mesh.triangles)
  {
    sets.unite (triangle[0], triangle[1]);
    sets.unite (triangle[0], triangle[2]);
  }
  return sets;
}

} // namespace

MeshTopology
computeTopology (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  MeshTopology topology;
  DisjointSets fans (3 * mesh.triangles.size ());
  const auto sides = sortedSides (mesh);
  int edges = 0;
  for (std::size_t begin = 0, end = 0; begin < sides.size (); begin = end)
  {
    int forward = 0;
    for (end = begin; end < sides.size () && sides[end].edge == sides[begin].edge; ++end)
    {
      forward += sides[end].forward;
      if (end > begin)
        uniteFans (mesh, sides[begin], sides[end], fans);
    }
    ++edges;
    const bool degenerate = (sides[begin].edge >> 32) == (sides[begin].edge & 0xffffffffu);
    if (degenerate || end - begin > 2 || (end - begin == 2 && forward != 1))
      ++topology.non_manifold_edges;
    else if (end - begin == 1)
      ++topology.boundary_edges;
  }

  std::vector<int> fans_of_vertex (mesh.vertices.size (), 0);
  for (std::size_t corner = 0; corner < 3 * mesh.triangles.size (); ++corner)
    if (fans.find (corner) == corner)
      ++fans_of_vertex[mesh.triangles[corner / 3][corner % 3]];
  int referenced = 0;
  DisjointSets connected = connectedVertices (mesh);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    if (fans_of_vertex[v] == 0)
      continue;
    ++referenced;
    topology.non_manifold_vertices += (fans_of_vertex[v] > 1);
    topology.components += (connected.find (v) == v);
  }
  topology.euler = referenced - edges + static_cast<int> (mesh.triangles.size ());
  topology.closed_manifold = !mesh.empty () && topology.boundary_edges == 0 && topology.non_manifold_edges == 0 &&
                             topology.non_manifold_vertices == 0;
  return topology;
}

std::vector<int>
labelComponents (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  DisjointSets connected = connectedVertices (mesh);
  std::vector<int> labels (mesh.vertices.size ());
  int count = 0;
  for (std::size_t v = 0; v < labels.size (); ++v)
  {
    const std::size_t first = connected.find (v); // the component's smallest vertex: already labelled, or v itself
    labels[v] = (first == v ? count++ : labels[first]);
  }
  return labels;
}

} // namespace cosection
} // namespace pcl
