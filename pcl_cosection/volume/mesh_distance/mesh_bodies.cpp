// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_bodies.h"

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/mesh/mesh_parts.h"
#include "pcl_cosection/mesh/mesh_sides.h"
#include "pcl_cosection/mesh/triangle_shape.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace pcl::cosection {
namespace {

bool
isFlat (const MeshPart& part)
{
  constexpr double flat = 1e-12; // of the cube over the diagonal; rounding is far below, a foil far above
  return std::abs (part.volume_m3) <= flat * std::pow (part.box.diagonal ().cast<double> ().norm (), 3);
}

Eigen::Vector3d
cornerOf (const TriangleMesh& mesh, std::size_t triangle, int n)
{
  return mesh.vertices[mesh.triangles[triangle][n % 3]].cast<double> ();
}

} // namespace

MeshBodies
divideBodies (const TriangleMesh& mesh)
{
  const auto parts = divideMesh (mesh);
  MeshBodies division;
  std::vector<std::vector<std::uint32_t>> bodies (parts.size ());
  for (std::size_t n = 0; n < parts.size (); ++n)
  {
    const auto& triangles = parts[n].triangles;
    if (!parts[n].closed)
    {
      division.sheets.insert (division.sheets.end (), triangles.begin (), triangles.end ());
      continue;
    }
    if (isFlat (parts[n]))
      continue;
    const std::size_t body = (parts[n].volume_m3 < 0.0 ? enclosingPart (mesh, parts, n).value_or (n) : n);
    bodies[body].insert (bodies[body].end (), triangles.begin (), triangles.end ());
  }
  for (auto& body : bodies)
    if (!body.empty ())
      division.bodies.push_back (std::move (body));
  return division;
}

Pseudonormals::Pseudonormals (const TriangleMesh& mesh)
    : triangles_ (mesh.triangles)
    , faces_ (mesh.triangles.size ())
    , edges_ (3 * mesh.triangles.size (), Eigen::Vector3d::Zero ())
    , vertices_ (mesh.vertices.size (), Eigen::Vector3d::Zero ())
    , regular_edges_ (3 * mesh.triangles.size (), 0)
    , regular_vertices_ (mesh.vertices.size (), 1)
{
  for (std::size_t t = 0; t < triangles_.size (); ++t)
  {
    faces_[t] = areaVector (cornerOf (mesh, t, 0), cornerOf (mesh, t, 1), cornerOf (mesh, t, 2)).normalized ();
    for (int n = 0; n < 3; ++n)
    {
      const Eigen::Vector3d u = cornerOf (mesh, t, n + 1) - cornerOf (mesh, t, n);
      const Eigen::Vector3d v = cornerOf (mesh, t, n + 2) - cornerOf (mesh, t, n);
      const double angle = std::atan2 (u.cross (v).norm (), u.dot (v));
      vertices_[triangles_[t][n]] += angle * faces_[t];
    }
  }

  DisjointSets fans (3 * triangles_.size ());
  const auto sides = sortedSides (mesh);
  forEachEdge (sides, [&] (std::size_t begin, std::size_t end) {
    const bool regular = isManifoldEdge (sides, begin, end);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    for (std::size_t s = begin; s < end; ++s)
      sum += faces_[sides[s].triangle];
    for (std::size_t s = begin; s < end; ++s)
    {
      const std::size_t side = 3 * static_cast<std::size_t> (sides[s].triangle) + sides[s].corner;
      edges_[side] = sum;
      regular_edges_[side] = regular;
      uniteFans (mesh, sides[begin], sides[s], fans);
      if (!regular)
        for (int n = 0; n < 2; ++n)
          regular_vertices_[triangles_[sides[s].triangle][(sides[s].corner + n) % 3]] = 0;
    }
  });
  std::vector<std::uint8_t> has_fan (vertices_.size (), 0);
  for (std::size_t corner = 0; corner < 3 * triangles_.size (); ++corner)
    if (fans.find (corner) == corner)
    {
      const std::uint32_t v = triangles_[corner / 3][corner % 3];
      if (has_fan[v] != 0)
        regular_vertices_[v] = 0;
      has_fan[v] = 1;
    }
}

double
Pseudonormals::side (const NearestPoint& nearest) const
{
  const std::size_t t = nearest.triangle;
  if (nearest.feature >= NearestPoint::Face)
    return nearest.offset_m.dot (faces_[t]);
  if (nearest.feature >= NearestPoint::Edge)
    return nearest.offset_m.dot (edges_[3 * t + nearest.feature - NearestPoint::Edge]);
  return nearest.offset_m.dot (vertices_[triangles_[t][nearest.feature]]);
}

bool
Pseudonormals::isRegular (const NearestPoint& nearest) const
{
  if (nearest.feature >= NearestPoint::Face)
    return true;
  if (nearest.feature >= NearestPoint::Edge)
    return regular_edges_[3 * static_cast<std::size_t> (nearest.triangle) + nearest.feature - NearestPoint::Edge] != 0;
  return regular_vertices_[triangles_[nearest.triangle][nearest.feature]] != 0;
}

SearchableSurface::SearchableSurface (const TriangleMesh& whole, const std::vector<std::uint32_t>& triangles)
    : mesh (selectTriangles (whole, triangles))
    , all (mesh.triangles.size ())
    , tree (mesh)
    , normals (mesh)
    , is_room (computeMassProperties (mesh).volume_m3 < 0.0)
{
  std::iota (all.begin (), all.end (), 0u);
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
}

double
SearchableSurface::side (const NearestPoint& nearest) const
{
  return std::isfinite (nearest.squared_m2) && normals.isRegular (nearest) ? normals.side (nearest) : 0.0;
}

bool
SearchableSurface::isInMatter (const Eigen::Vector3d& p) const
{
  // Winding numbers are 1 inside a body and 0 outside, -1 in a room and 0 in its matter.
  return windingNumber (mesh, all, p) > (is_room ? -0.5 : 0.5);
}

} // namespace pcl::cosection
