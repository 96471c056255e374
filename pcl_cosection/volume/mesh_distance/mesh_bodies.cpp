// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_bodies.h"

#include "pcl_cosection/mesh/mesh_parts.h"

#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

bool
isFlat (const MeshPart& part)
{
  constexpr double flat = 1e-12; // of the cube over the diagonal; rounding is far below, a foil far above
  return std::abs (part.volume_m3) <= flat * std::pow (part.box.diagonal ().cast<double> ().norm (), 3);
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

SearchableSurface::SearchableSurface (const TriangleMesh& whole, const std::vector<std::uint32_t>& triangles)
    : mesh (selectTriangles (whole, triangles))
    , tree (mesh)
    , normals (mesh)
{
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
}

} // namespace pcl::cosection
