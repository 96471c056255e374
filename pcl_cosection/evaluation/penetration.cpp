// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/penetration.h>

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/volume/mesh_distance/mesh_bodies.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double max_voxels = 2e8;
constexpr double touching_m = 1e-7; ///< rounding of coordinates, no penetration
constexpr double room_share = 0.5;  ///< of the diagonal of everything

double
diagonal (const TriangleMesh& mesh)
{
  const Eigen::AlignedBox3f box = vertexBox (mesh).cast<float> ();
  return box.isEmpty () ? 0.0 : static_cast<double> (box.diagonal ().norm ());
}

} // namespace

/** \brief How deep points lie in the matter that a mesh bounds, by the rules of sampleSignedDistance (); but a closed
 * part that faces inward and is less than half as long as the whole is a cavity in matter that something else bounds,
 * and says nothing. */
class SolidDepth
{
public:
  /** \param[in] band_m how far behind open parts there is matter; 0: there is none */
  SolidDepth (const TriangleMesh& mesh, double band_m) : band_m_ (band_m)
  {
    const TriangleMesh clean = dropBackToBack (cleanMesh (mesh));
    const MeshBodies division = divideBodies (clean);
    const double whole_m = diagonal (clean);
    for (const auto& triangles : division.bodies)
    {
      auto body = std::make_unique<SearchableSurface> (clean, triangles);
      if (body->is_room && diagonal (body->mesh) < room_share * whole_m)
        continue; // a cavity in the matter of others, not a room that everything is in
      bodies_.push_back (std::move (body));
    }
    if (!division.sheets.empty ())
      sheets_ = std::make_unique<SearchableSurface> (clean, division.sheets);
  }

  /** \brief Metres to the surface of the body that \a p lies deepest in, or to the open part that it lies behind; 0
   * outside. */
  double at (const Eigen::Vector3d& p) const
  {
    double depth_m = 0.0;
    for (const auto& body : bodies_)
      if (body->is_room || body->box.contains (p))
      {
        const NearestPoint nearest = body->tree.nearest (p);
        const double side = body->side (nearest);
        if (side < 0.0 || (side == 0.0 && body->isInMatter (p)))
          depth_m = std::max (depth_m, std::sqrt (nearest.squared_m2));
      }
    if (sheets_ && band_m_ > 0.0 && sheets_->box.squaredExteriorDistance (p) <= band_m_ * band_m_)
    {
      const NearestPoint nearest = sheets_->tree.nearest (p, band_m_);
      if (sheets_->side (nearest) < 0.0)
        depth_m = std::max (depth_m, std::sqrt (nearest.squared_m2));
    }
    return depth_m;
  }

  bool hasBodies () const { return !bodies_.empty (); }

  /** \brief Whether a closed part faces inward, with matter all around it. */
  bool hasRoom () const
  {
    return std::any_of (bodies_.begin (), bodies_.end (), [] (const auto& body) { return body->is_room; });
  }

  /** \brief The parts that bound matter. \param[in] open those that are open, too */
  TriangleMesh parts (bool open) const
  {
    TriangleMesh mesh;
    for (const auto& body : bodies_)
      appendMesh (mesh, body->mesh);
    if (open && sheets_)
      appendMesh (mesh, sheets_->mesh);
    return mesh;
  }

  /** \brief Whether some of the mesh is open. */
  bool hasSheets () const { return sheets_ != nullptr; }

private:
  std::vector<std::unique_ptr<SearchableSurface>> bodies_;
  std::unique_ptr<SearchableSurface> sheets_;
  double band_m_;
};

void
PenetrationOptions::validate () const
{
  if (samples > static_cast<std::size_t> (std::numeric_limits<int>::max ()))
    throw InvalidArgument ("samples must fit into 31 bits, but is " + std::to_string (samples));
  if (!(voxel_size_m >= 0.0 && std::isfinite (voxel_size_m)))
    throw InvalidArgument ("voxel_size_m must be a number of metres, 0 or more");
  if (voxels < 1)
    throw InvalidArgument ("voxels must be at least 1");
  if (!(band_m > 0.0 && std::isfinite (band_m)))
    throw InvalidArgument ("band_m must be a positive number of metres");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

PenetrationBody::PenetrationBody (const TriangleMesh& mesh, const PenetrationOptions& options) : options_ (options)
{
  options.validate ();
  box_ = summarizeMesh (mesh).box;
  points_ = sampleSurface (mesh, options.samples, options.seed);
  std::vector<bool> used (mesh.vertices.size (), false);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      used[v] = true;
  const std::size_t limit = options.max_vertices > 0 ? options.max_vertices : used.size ();
  const std::size_t step = std::max<std::size_t> (1, (used.size () + limit - 1) / limit);
  for (std::size_t v = 0; v < used.size (); v += step)
    if (used[v])
      points_.push_back (mesh.vertices[v].cast<double> ());
  solid_ = std::make_unique<SolidDepth> (mesh, options.open_parts ? options.band_m : 0.0);
}

PenetrationBody::~PenetrationBody () = default;
PenetrationBody::PenetrationBody (PenetrationBody&&) noexcept = default;
PenetrationBody& PenetrationBody::operator= (PenetrationBody&&) noexcept = default;

bool
PenetrationBody::isOpen () const
{
  return solid_->hasSheets () || !solid_->hasBodies ();
}

bool
PenetrationBody::hasVolume () const
{
  return solid_->hasBodies ();
}

double
PenetrationBody::depthOf (const PenetrationBody& other, const Eigen::Isometry3d& T_this_other) const
{
  std::vector<double> depths (other.points_.size ());
  parallelFor (0, static_cast<int> (depths.size ()), options_.threads,
               [&] (int n) { depths[n] = solid_->at (T_this_other * other.points_[n]); });
  const double depth_m = *std::max_element (depths.begin (), depths.end ());
  return depth_m > touching_m ? depth_m : 0.0;
}

std::optional<double>
PenetrationBody::sharedVolume (const PenetrationBody& other, const Eigen::Isometry3d& T_this_other) const
{
  if (!hasVolume () || !other.hasVolume ())
    return std::nullopt;
  Eigen::AlignedBox3d common = other.box_.transformed (T_this_other);
  const double voxel_m = options_.voxel_size_m > 0.0
                             ? options_.voxel_size_m
                             : std::min (box_.sizes ().maxCoeff (), common.sizes ().maxCoeff ()) / options_.voxels;
  // Matter around a room has no box; that of another body has.
  if (solid_->hasRoom () && other.solid_->hasRoom ())
    return std::nullopt;
  if (other.solid_->hasRoom ())
    common = box_;
  else if (!solid_->hasRoom ())
    common = common.intersection (box_);
  if (common.isEmpty ())
    return 0.0;
  const Eigen::Array3d size = (common.sizes ().array () / voxel_m).ceil ().max (1.0);
  if (size.prod () > max_voxels)
    throw InvalidArgument ("voxel_size_m is too small: the common box has more than 2e8 voxels");
  VoxelGrid grid;
  grid.dims = size.cast<int> ();
  grid.voxel_size_m = voxel_m;
  grid.origin_m = common.center ().array () - 0.5 * voxel_m * (size - 1.0);

  const auto distanceOf = [&] (const PenetrationBody& body, const Eigen::Isometry3d& pose) {
    const SolidDepth& solid = *body.solid_;
    return sampleSignedDistance (transformMesh (solid.parts (body.options_.open_parts), pose), grid,
                                 solid.hasSheets () ? body.options_.band_m : voxel_m, options_.threads);
  };
  const SignedDistanceField a = distanceOf (*this, Eigen::Isometry3d::Identity ());
  const SignedDistanceField b = distanceOf (other, T_this_other);
  const auto isInside = [] (const SignedDistanceField& field, std::size_t n) {
    return field.values[n] < 0.0f && (field.supported.empty () || field.supported[n] != 0);
  };
  std::size_t count = 0;
  for (std::size_t n = 0; n < grid.size (); ++n)
    count += isInside (a, n) && isInside (b, n);
  return static_cast<double> (count) * voxel_m * voxel_m * voxel_m;
}

} // namespace pcl::cosection
