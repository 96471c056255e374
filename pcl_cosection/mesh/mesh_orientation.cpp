// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_orientation.h"
#include "mesh_parts.h"
#include "mesh_sides.h"

#include <algorithm>
#include <utility>

namespace pcl::cosection {
namespace {

struct Neighbour
{
  std::uint32_t triangle;
  bool agrees; ///< runs along the common edge the other way
};

/** \brief The neighbours of each triangle across edges of two. */
std::vector<std::vector<Neighbour>>
neighboursOfTriangles (const TriangleMesh& mesh)
{
  std::vector<std::vector<Neighbour>> neighbours (mesh.triangles.size ());
  const auto sides = sortedSides (mesh);
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    if (end - begin != 2)
      return;
    const Side& a = sides[begin];
    const Side& b = sides[begin + 1];
    neighbours[a.triangle].push_back ({b.triangle, a.forward != b.forward});
    neighbours[b.triangle].push_back ({a.triangle, a.forward != b.forward});
  });
  return neighbours;
}

void
flip (TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles)
{
  for (const std::uint32_t t : triangles)
    std::swap (mesh.triangles[t][1], mesh.triangles[t][2]);
}

void
alignNeighbours (TriangleMesh& mesh)
{
  const auto neighbours = neighboursOfTriangles (mesh);
  std::vector<bool> reached (mesh.triangles.size (), false);
  std::vector<bool> turned (mesh.triangles.size (), false);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size (); ++seed)
  {
    if (reached[seed])
      continue;
    std::vector<std::uint32_t> patch = {seed};
    reached[seed] = true;
    for (std::size_t n = 0; n < patch.size (); ++n)
      for (const Neighbour& neighbour : neighbours[patch[n]])
        if (!reached[neighbour.triangle])
        {
          reached[neighbour.triangle] = true;
          turned[neighbour.triangle] = (neighbour.agrees ? turned[patch[n]] : !turned[patch[n]]);
          patch.push_back (neighbour.triangle);
        }
    const auto is_turned = [&] (std::uint32_t t) { return static_cast<bool> (turned[t]); };
    const auto count = static_cast<std::size_t> (std::count_if (patch.begin (), patch.end (), is_turned));
    const bool wanted = 2 * count <= patch.size ();
    patch.erase (std::remove_if (patch.begin (), patch.end (), [&] (auto t) { return is_turned (t) != wanted; }),
                 patch.end ());
    flip (mesh, patch);
  }
}

} // namespace

void
orientTriangles (TriangleMesh& mesh)
{
  alignNeighbours (mesh);
  auto parts = divideMesh (mesh);
  double volume = 0.0;
  for (const MeshPart& part : parts)
    volume += part.volume_m3;
  const auto flip_part = [&mesh] (MeshPart& part) {
    flip (mesh, part.triangles);
    part.volume_m3 = -part.volume_m3;
  };
  if (volume < 0.0)
    for (MeshPart& part : parts)
      if (part.closed)
        flip_part (part);
  std::vector<std::size_t> inward;
  for (std::size_t n = 0; n < parts.size (); ++n)
    if (parts[n].volume_m3 < 0.0 && !enclosingPart (mesh, parts, n))
      inward.push_back (n);
  for (const std::size_t n : inward)
    flip_part (parts[n]);
}

} // namespace pcl::cosection
