// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid_depth.h"

#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/mesh/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr double room_share = 0.5; // of the diagonal of everything

double
diagonal (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex);
  return box.isEmpty () ? 0.0 : static_cast<double> (box.diagonal ().norm ());
}

} // namespace

SolidDepth::SolidDepth (const TriangleMesh& mesh, double band_m) : band_m_ (band_m)
{
  const TriangleMesh clean = dropBackToBack (cleanMesh (mesh));
  const MeshBodies division = divideBodies (clean);
  const double whole_m = diagonal (clean);
  for (const auto& triangles : division.bodies)
  {
    Body body;
    body.surface = std::make_unique<SearchableSurface> (clean, triangles);
    body.is_room = computeMassProperties (body.surface->mesh).volume_m3 < 0.0;
    if (body.is_room && diagonal (body.surface->mesh) < room_share * whole_m)
      continue; // a cavity in the matter of others, not a room that everything is in
    body.all.resize (body.surface->mesh.triangles.size ());
    std::iota (body.all.begin (), body.all.end (), 0u);
    bodies_.push_back (std::move (body));
  }
  if (!division.sheets.empty ())
    sheets_ = std::make_unique<SearchableSurface> (clean, division.sheets);
}

bool
SolidDepth::hasRoom () const
{
  return std::any_of (bodies_.begin (), bodies_.end (), [] (const Body& body) { return body.is_room; });
}

TriangleMesh
SolidDepth::closedParts () const
{
  TriangleMesh mesh;
  for (const Body& body : bodies_)
    appendMesh (mesh, body.surface->mesh);
  return mesh;
}

double
SolidDepth::depthIn (const Body& body, const Eigen::Vector3d& p) const
{
  const SearchableSurface& surface = *body.surface;
  if (!body.is_room && !surface.box.contains (p))
    return 0.0;
  const NearestPoint nearest = surface.tree.nearest (p);
  double side = surface.normals.isRegular (nearest) ? surface.normals.side (nearest) : 0.0;
  if (side == 0.0) // winding numbers are 1 inside a body and 0 outside, -1 in a room and 0 in its matter
    side = windingNumber (surface.mesh, body.all, p) > (body.is_room ? -0.5 : 0.5) ? -1.0 : 1.0;
  return side < 0.0 ? std::sqrt (nearest.squared_m2) : 0.0;
}

double
SolidDepth::at (const Eigen::Vector3d& p) const
{
  double depth_m = 0.0;
  for (const Body& body : bodies_)
    depth_m = std::max (depth_m, depthIn (body, p));
  if (sheets_ && band_m_ > 0.0 && sheets_->box.squaredExteriorDistance (p) <= band_m_ * band_m_)
  {
    const NearestPoint nearest = sheets_->tree.nearest (p, band_m_);
    if (std::isfinite (nearest.squared_m2) && sheets_->normals.isRegular (nearest) &&
        sheets_->normals.side (nearest) < 0.0)
      depth_m = std::max (depth_m, std::sqrt (nearest.squared_m2));
  }
  return depth_m;
}

} // namespace pcl::cosection
