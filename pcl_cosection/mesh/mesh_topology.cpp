// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_checks.h"
#include "mesh_sides.h"
#include "pcl_cosection/common/disjoint_sets.h"

#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection {
namespace {

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
  return connectedVertices (mesh).numbers ();
}

} // namespace pcl::cosection
