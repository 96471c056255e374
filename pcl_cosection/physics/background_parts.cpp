// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/background_parts.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/object_solid.h"
#include "pcl_cosection/physics/part_contacts.h"
#include "pcl_cosection/physics/resting.h"
#include "pcl_cosection/physics/visual_mesh.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

namespace pcl::cosection {

namespace {

constexpr double plane_voxels = 3.0;       // what is nearer to a support plane is a part of it
constexpr double first_cell_voxels = 10.0; // edge of a patch
constexpr double growth = 1.5;             // of patches, while there are too many
constexpr std::size_t most_patches = 200;

/** \brief Whether a place is neither near planes nor behind them, and has numbers as coordinates. */
bool
isBeside (const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& p, double reach_m)
{
  return p.allFinite () && std::none_of (planes.begin (), planes.end (), [&] (const Eigen::Vector4d& plane) {
           return heightOver (plane, p) < reach_m;
         });
}

/** \brief Triangles of which all corners are beside the planes. */
std::vector<TriangleMesh::Triangle>
remainder (const TriangleMesh& mesh, const std::vector<Eigen::Vector4d>& planes, double reach_m)
{
  std::vector<bool> is_left_out (mesh.vertices.size (), false);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    is_left_out[v] = !isBeside (planes, mesh.vertices[v].cast<double> (), reach_m);
  std::vector<TriangleMesh::Triangle> rest;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
    if (!is_left_out[t[0]] && !is_left_out[t[1]] && !is_left_out[t[2]])
      rest.push_back (t);
  return rest;
}

using Patches = std::map<std::array<std::int64_t, 3>, std::vector<Eigen::Vector3d>>;

/** \brief The points of triangles by cells of a grid: on the surface, and a voxel behind it. \return nothing if these
 * are too many cells, or too far away */
std::optional<Patches>
patchesOf (const TriangleMesh& mesh, const std::vector<TriangleMesh::Triangle>& triangles, double cell_m,
           double thickness_m)
{
  Patches patches;
  for (const TriangleMesh::Triangle& t : triangles)
  {
    std::array<Eigen::Vector3d, 3> corners;
    for (int n = 0; n < 3; ++n)
      corners[n] = mesh.vertices[t[n]].cast<double> ();
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross (corners[2] - corners[0]).normalized ();
    const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const std::optional<CellIndex> cell = cellOf (middle / cell_m);
    if (!cell)
      return std::nullopt;
    std::vector<Eigen::Vector3d>& points = patches[{cell->x (), cell->y (), cell->z ()}];
    if (patches.size () > most_patches)
      return std::nullopt;
    for (const Eigen::Vector3d& corner : corners)
      for (const double depth : {0.0, thickness_m})
        points.push_back (corner - depth * normal);
  }
  return patches;
}

/** \brief What of a hull keeps clear of the objects; empty if nothing does. */
ConvexHull
clearOf (const std::vector<BodyParts>& objects, ConvexHull hull, double tolerance_m)
{
  for (const BodyParts& object : objects)
    for (const ConvexHull& part : object.hulls)
      if (!hull.empty ())
        if (const Separation found = separationOf (part, hull); found.depth_m > tolerance_m)
        {
          Eigen::Vector4d plane; // the part stays as it is
          plane << -found.normal, found.offset + 0.5 * found.depth_m;
          hull = cutBehind (hull, plane);
        }
  return hull;
}

} // namespace

std::vector<Eigen::Vector3d>
backgroundBesidePlanes (const CompletedScene& scene, const PhysicalScene& result,
                        const std::vector<Eigen::Vector4d>& planes)
{
  const Eigen::Isometry3d T_scene_world = result.T_result_scene.inverse ();
  const double reach_m = plane_voxels * largestVoxelSizeOf (scene);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& vertex : scene.background.vertices)
    if (const Eigen::Vector3d p = T_scene_world * vertex.cast<double> (); isBeside (planes, p, reach_m))
      points.push_back (p);
  return points;
}

bool
touchesSurroundings (const CollisionSource& source, const std::vector<Eigen::Vector4d>& planes,
                     const Eigen::Vector3d& up, const std::vector<Eigen::Vector3d>& background)
{
  const double reach_m = touching_voxels * source.voxel_size_m;
  if (std::any_of (planes.begin (), planes.end (), [&] (const Eigen::Vector4d& plane) {
        return !isLevel (plane, up) && std::abs (lowestOver (plane, source.mesh)) < reach_m;
      }))
    return true;
  const Eigen::AlignedBox3d box = vertexBox (source.mesh);
  const SurfaceDistance surface (source.mesh);
  return std::any_of (background.begin (), background.end (), [&] (const Eigen::Vector3d& p) {
    return box.exteriorDistance (p) < reach_m && (surface.nearest (p).point - p).norm () < reach_m;
  });
}

void
addBackground (const CompletedScene& scene, const std::vector<Eigen::Vector4d>& planes,
               const std::vector<BodyParts>& objects, PhysicalScene& result)
{
  if (scene.background.empty ())
    return;
  const double voxel = largestVoxelSizeOf (scene);
  PhysicalBody body;
  body.name = background_name;
  body.visual = movedMesh (scene.background, result.T_result_scene.inverse ());
  body.colour = meanColour (scene.background, body.colour);
  const std::vector<TriangleMesh::Triangle> rest = remainder (body.visual, planes, plane_voxels * voxel);
  std::optional<Patches> patches;
  for (double cell = first_cell_voxels * voxel; !patches; cell *= growth)
    patches = patchesOf (body.visual, rest, cell, voxel);
  for (const auto& [cell, points] : *patches)
  {
    const ConvexHull hull = clearOf (objects, convexHullOf (points), result.contact_tolerance_m);
    const TriangleMesh part = hull.mesh ();
    if (!isSolid (part))
      continue;
    body.parts.push_back (part);
    body.parts_volume_m3 += hull.volume_m3;
  }
  result.bodies.push_back (std::move (body));
}

} // namespace pcl::cosection
