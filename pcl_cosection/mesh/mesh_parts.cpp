// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_parts.h"
#include "mesh_sides.h"
#include "pcl_cosection/common/disjoint_sets.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

Eigen::Matrix3d
cornersAbout (const TriangleMesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& apex)
{
  Eigen::Matrix3d corners;
  for (int n = 0; n < 3; ++n)
    corners.col (n) = mesh.vertices[mesh.triangles[triangle][n]].cast<double> () - apex;
  return corners;
}

/** \brief The sets of triangles at the edge [begin, end) that have not as many sides one way as the other. */
std::vector<std::size_t>
openSets (const std::vector<Side>& sides, std::size_t begin, std::size_t end, DisjointSets& sets)
{
  std::map<std::size_t, int> excess;
  for (std::size_t s = begin; s < end; ++s)
    excess[sets.find (sides[s].triangle)] += (sides[s].forward ? 1 : -1);
  std::vector<std::size_t> open;
  for (const auto& set : excess)
    if (set.second != 0)
      open.push_back (set.first);
  return open;
}

/** \brief For each forward side of an edge the backward one that bounds the same matter between them, by the
 * angles of their triangles about the edge; nothing if they do not all have one of their own. */
std::vector<std::pair<const Side*, const Side*>>
pairsAroundMatter (const TriangleMesh& mesh, const std::vector<Side>& sides, std::size_t begin, std::size_t end)
{
  const Side& first = sides[begin];
  const auto corner = [&mesh] (const Side& side, int n) -> Eigen::Vector3d {
    return mesh.vertices[mesh.triangles[side.triangle][(side.corner + n) % 3]].cast<double> ();
  };
  const Eigen::Vector3d origin = corner (first, 0);
  const Eigen::Vector3d along = (corner (first, 1) - origin).normalized () * (first.forward ? 1.0 : -1.0);
  const Eigen::Vector3d u = along.unitOrthogonal ();
  const Eigen::Vector3d v = along.cross (u);
  const auto angle = [&] (const Side& side) {
    const Eigen::Vector3d w = corner (side, 2) - origin;
    return std::atan2 (v.dot (w), u.dot (w));
  };
  std::vector<std::pair<const Side*, const Side*>> pairs;
  std::set<const Side*> taken;
  for (std::size_t f = begin; f < end; ++f)
  {
    if (!sides[f].forward)
      continue;
    const Side* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity ();
    for (std::size_t b = begin; b < end; ++b)
    {
      constexpr double same = 1e-6; // at the same angle are those of two bodies back to back
      double matter = angle (sides[f]) - angle (sides[b]);
      while (matter < same)
        matter += 2.0 * M_PI;
      if (!sides[b].forward && matter < least)
      {
        least = matter;
        nearest = &sides[b];
      }
    }
    if (nearest == nullptr || !taken.insert (nearest).second)
      return {};
    pairs.emplace_back (&sides[f], nearest);
  }
  if (2 * pairs.size () != end - begin)
    return {};
  return pairs;
}

DisjointSets
connectedTriangles (const TriangleMesh& mesh, const std::vector<Side>& sides)
{
  DisjointSets patches (mesh.triangles.size ());
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    if (isManifoldEdge (sides, begin, end))
      patches.unite (sides[begin].triangle, sides[begin + 1].triangle);
  });
  DisjointSets parts = patches; // what is open is asked of the patches, whatever was united before
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    if (isManifoldEdge (sides, begin, end))
      return;
    const auto open = openSets (sides, begin, end, patches);
    if (open.empty ())
      return;
    const auto pairs = pairsAroundMatter (mesh, sides, begin, end);
    for (const auto& pair : pairs)
      parts.unite (pair.first->triangle, pair.second->triangle);
    for (std::size_t n = 1; n < open.size () && pairs.empty (); ++n)
      parts.unite (open[0], open[n]);
  });
  return parts;
}

/** \brief Volume within a closed part, by tetrahedra about one of its vertices. */
double
enclosedVolume (const TriangleMesh& mesh, const MeshPart& part)
{
  const Eigen::Vector3d apex = mesh.vertices[mesh.triangles[part.triangles[0]][0]].cast<double> ();
  double sum = 0.0;
  for (const std::uint32_t t : part.triangles)
    sum += cornersAbout (mesh, t, apex).determinant ();
  return sum / 6.0;
}

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

std::vector<MeshPart>
divideMesh (const TriangleMesh& mesh)
{
  const auto sides = sortedSides (mesh);
  DisjointSets sets = connectedTriangles (mesh, sides);
  const std::vector<int> part_of = sets.numbers ();
  std::vector<MeshPart> parts (part_of.empty () ? 0 : 1 + *std::max_element (part_of.begin (), part_of.end ()));
  for (MeshPart& part : parts)
    part.closed = true;
  for (std::uint32_t t = 0; t < mesh.triangles.size (); ++t)
  {
    MeshPart& part = parts[part_of[t]];
    part.triangles.push_back (t);
    for (const auto v : mesh.triangles[t])
      part.box.extend (mesh.vertices[v]);
  }
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    if (!isManifoldEdge (sides, begin, end))
      for (const std::size_t set : openSets (sides, begin, end, sets))
        parts[part_of[set]].closed = false;
  });
  for (MeshPart& part : parts)
    if (part.closed)
      part.volume_m3 = enclosedVolume (mesh, part);
  return parts;
}

TriangleMesh
selectTriangles (const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles)
{
  std::vector<std::uint32_t> used;
  used.reserve (3 * triangles.size ());
  for (const std::uint32_t t : triangles)
    used.insert (used.end (), mesh.triangles[t].begin (), mesh.triangles[t].end ());
  std::sort (used.begin (), used.end ());
  used.erase (std::unique (used.begin (), used.end ()), used.end ());
  TriangleMesh selected;
  for (const std::uint32_t v : used)
    selected.vertices.push_back (mesh.vertices[v]);
  for (const std::uint32_t t : triangles)
  {
    selected.triangles.push_back (mesh.triangles[t]);
    for (auto& v : selected.triangles.back ())
      v = static_cast<std::uint32_t> (std::lower_bound (used.begin (), used.end (), v) - used.begin ());
  }
  return selected;
}

std::optional<std::size_t>
enclosingPart (const TriangleMesh& mesh, const std::vector<MeshPart>& parts, std::size_t inner)
{
  constexpr double inside = 0.5;
  const Eigen::Vector3d p = mesh.vertices[mesh.triangles[parts[inner].triangles[0]][0]].cast<double> ();
  std::optional<std::size_t> smallest;
  for (std::size_t n = 0; n < parts.size (); ++n)
  {
    const MeshPart& part = parts[n];
    if (n == inner || !part.closed || part.volume_m3 <= 0.0 || !part.box.contains (parts[inner].box))
      continue;
    if (smallest && parts[*smallest].volume_m3 <= part.volume_m3)
      continue;
    if (windingNumber (mesh, part.triangles, p) > inside)
      smallest = n;
  }
  return smallest;
}

double
windingNumber (const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles, const Eigen::Vector3d& p)
{
  double solid_angle = 0.0;
  for (const std::uint32_t t : triangles)
  {
    const Eigen::Matrix3d corners = cornersAbout (mesh, t, p);
    const Eigen::Vector3d length = corners.colwise ().norm ();
    // A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983, equation (8).
    const double denominator = length.prod () + corners.col (0).dot (corners.col (1)) * length[2] +
                               corners.col (1).dot (corners.col (2)) * length[0] +
                               corners.col (2).dot (corners.col (0)) * length[1];
    solid_angle += 2.0 * std::atan2 (corners.determinant (), denominator);
  }
  return solid_angle / (4.0 * M_PI);
}

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
