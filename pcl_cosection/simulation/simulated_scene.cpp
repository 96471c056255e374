// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace pcl::cosection {
namespace {

constexpr int union_resolution = 200; // voxels along the longest side
constexpr int union_margin = 3;       // voxels around it
constexpr int block = 8;              // voxels along its sides
constexpr int projection_steps = 4;
constexpr double max_projection_vox = 0.9;

bool
isFileName (const std::string& name)
{
  return !name.empty () && name[0] != '.' && std::none_of (name.begin (), name.end (), [] (unsigned char c) {
    return c <= ' ' || c == 0x7f || c == '/' || c == '\\';
  });
}

std::string
printable (std::string text)
{
  for (char& c : text)
    c = static_cast<unsigned char> (c) < ' ' || c == 0x7f ? '?' : c;
  return text;
}

Eigen::Vector3d
toPart (const BodyPart& part, const Eigen::Vector3d& p)
{
  return part.T_body_part.linear ().transpose () * (p - part.T_body_part.translation ());
}

Eigen::Vector3d
gradient (const SceneBody& body, const Eigen::Vector3d& p, double step)
{
  Eigen::Vector3d g;
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit (a);
    g[a] = (body.distance (p + d) - body.distance (p - d)) / (2.0 * step);
  }
  return g;
}

/** \brief The zero set of a body's distance, its vertices moved onto it. */
TriangleMesh
unionSurface (const SceneBody& body, const Eigen::AlignedBox3d& box)
{
  SignedDistanceField field;
  field.grid.voxel_size_m = box.sizes ().maxCoeff () / union_resolution;
  field.grid.origin_m = box.min () - Eigen::Vector3d::Constant (union_margin * field.grid.voxel_size_m);
  field.grid.dims = ((box.sizes () / field.grid.voxel_size_m).array ().ceil ().cast<int> () + 2 * union_margin + 1)
                        .matrix ();
  field.values.resize (field.grid.size ());
  const VoxelGrid& grid = field.grid;
  // The distance at the middle of a block bounds that in all of it.
  const double half_block_m = 0.5 * std::sqrt (3.0) * (block - 1) * grid.voxel_size_m;
  const Eigen::Vector3i blocks = (grid.dims.array () + block - 1) / block;
  parallelFor (0, blocks.prod (), 0, [&] (int b) {
    const Eigen::Vector3i first = block * Eigen::Vector3i (b % blocks.x (), b / blocks.x () % blocks.y (),
                                                           b / blocks.x () / blocks.y ());
    const Eigen::Vector3i last = (first.array () + block).min (grid.dims.array ());
    const Eigen::Vector3d middle = grid.origin_m + grid.voxel_size_m * (first.cast<double> () +
                                                                        Eigen::Vector3d::Constant (0.5 * (block - 1)));
    const double at_middle = body.distance (middle);
    const bool far = std::abs (at_middle) > half_block_m + 2.0 * grid.voxel_size_m;
    for (int k = first.z (); k < last.z (); ++k)
      for (int j = first.y (); j < last.y (); ++j)
        for (int i = first.x (); i < last.x (); ++i)
          field.values[grid.index (i, j, k)] = static_cast<float> (far ? at_middle
                                                                       : body.distance (grid.center (i, j, k)));
  });
  TriangleMesh mesh = extractIsoSurface (field);
  mesh.normals.clear ();
  const double farthest = max_projection_vox * grid.voxel_size_m;
  parallelFor (0, static_cast<int> (mesh.vertices.size ()), 0, [&] (int v) {
    const Eigen::Vector3d start = mesh.vertices[v].cast<double> ();
    Eigen::Vector3d p = start;
    for (int n = 0; n < projection_steps; ++n)
    {
      const Eigen::Vector3d g = gradient (body, p, 1e-3 * grid.voxel_size_m);
      if (!(g.squaredNorm () > 0.25))
        break;
      p -= body.distance (p) / g.squaredNorm () * g;
    }
    if ((p - start).norm () <= farthest && std::abs (body.distance (p)) < std::abs (body.distance (start)))
      mesh.vertices[v] = p.cast<float> ();
  });
  return mesh;
}

} // namespace

double
SceneBody::distance (const Eigen::Vector3d& p) const
{
  double nearest = std::numeric_limits<double>::infinity ();
  for (const BodyPart& part : parts)
    nearest = std::min (nearest, part.shape->distance (toPart (part, p)));
  return nearest;
}

bool
SceneBody::isSupported (const Eigen::Vector3d& p) const
{
  return std::all_of (parts.begin (), parts.end (),
                      [&] (const BodyPart& part) { return part.shape->isSupported (toPart (part, p)); });
}

TriangleMesh
SceneBody::surface (double chord_m) const
{
  TriangleMesh all;
  for (const BodyPart& part : parts)
    appendMesh (all, transformMesh (part.shape->tessellate (chord_m), part.T_body_part));
  const bool analytic = std::all_of (parts.begin (), parts.end (),
                                     [] (const BodyPart& part) { return part.shape->isAnalytic (); });
  if (id == 0 || parts.size () == 1 || !analytic)
    return all;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : all.vertices)
    box.extend (v.cast<double> ());
  return unionSurface (*this, box);
}

void
SimulatedScene::validate () const
{
  camera.validate ();
  if (noise)
    noise->validate ();
  if (frames < 1)
    throw InvalidArgument ("frames must be a positive number");
  if (!(std::isfinite (rate) && rate > 0.0))
    throw InvalidArgument ("rate must be a positive number of frames per second");
  if (!(std::isfinite (depth_scale) && depth_scale > 0.0))
    throw InvalidArgument ("depth.scale must be a positive number of units per metre");
  if (views_every < 0)
    throw InvalidArgument ("views.every must not be negative");
  if (bodies.empty () || bodies.front ().id != 0)
    throw InvalidArgument ("the first body must be the background");
  std::set<int> ids;
  std::set<std::string> names;
  for (const SceneBody& body : bodies)
  {
    if (!isFileName (body.name))
      throw InvalidArgument ("\"" + printable (body.name) +
                             "\" is no name for an object: it becomes part of file names");
    const bool is_background_name = body.name == "room" || body.name == "background";
    if (body.id == 0 && !is_background_name)
      throw InvalidArgument ("the background is called " + body.name + "; it must be room or background");
    if (body.id != 0 && (is_background_name || body.name == "cam"))
      throw InvalidArgument ("an object must not be called " + body.name +
                             ": the files of the truth would be mistaken");
    if (body.id < 0 || body.id >= ignored_label || !ids.insert (body.id).second)
      throw InvalidArgument ("the id " + std::to_string (body.id) + " of " + body.name +
                             " is used twice, or not from 1 to 65534");
    if (!names.insert (body.name).second)
      throw InvalidArgument ("two objects are called " + body.name);
    if (body.parts.empty () && body.id != 0)
      throw InvalidArgument (body.name + " has no shape");
    for (const BodyPart& part : body.parts)
      if (!part.shape || !part.T_body_part.matrix ().allFinite ())
        throw InvalidArgument (body.name + " has a part without shape or pose");
    if (!(std::isfinite (body.pattern_size_m) && body.pattern_size_m >= 0.0))
      throw InvalidArgument ("pattern_size of " + body.name + " must not be negative");
  }
}

} // namespace pcl::cosection
