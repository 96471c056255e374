// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/volume/mesh_distance.h>

#include "mesh_bodies.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/mesh_checks.h"
#include "pcl_cosection/mesh/mesh_cleaning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pcl::cosection {
namespace {

// ---- Rows of voxels -----------------------------------------------------------------------------

/** \brief The voxels [first, last). */
struct VoxelRange
{
  Eigen::Vector3i first, last;
};

/** \brief The voxels within \a reach_m of a box, and perhaps a few more. */
VoxelRange
voxelsAround (const VoxelGrid& grid, const Eigen::AlignedBox3d& box, double reach_m)
{
  const Eigen::Vector3d low = grid.toVoxel (box.min ().array () - reach_m);
  const Eigen::Vector3d high = grid.toVoxel (box.max ().array () + reach_m);
  VoxelRange range;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double end = grid.dims[axis];
    range.first[axis] = static_cast<int> (std::clamp (std::floor (low[axis]), 0.0, end));
    range.last[axis] = static_cast<int> (std::clamp (std::ceil (high[axis]) + 1.0, 0.0, end));
  }
  return range;
}

/** \brief Call \a body (k) for the slices of a range, which are independent of each other. */
template <typename Body>
void
forEachSlice (const VoxelRange& range, int threads, Body&& body)
{
  const Eigen::Vector3i size = (range.last - range.first).cwiseMax (0);
  const std::size_t voxels = static_cast<std::size_t> (size.x ()) * size.y () * size.z ();
  if (voxels == 0)
    return;
  // Neighbouring slices take about as long as each other: every thread gets some from everywhere.
  const int n = threadsForVoxels (threads, voxels);
  parallelFor (0, n, n, [&] (int thread) {
    for (int k = range.first.z () + thread; k < range.last.z (); k += n)
      body (k);
  });
}

/** \brief Visits rows of voxels by their nearest points. What is farther off than a reach is only seen from
 * time to time, for from a voxel at distance d those nearer than d - reach are as well. */
class RowWalker
{
public:
  RowWalker (const VoxelGrid& grid, const TriangleTree& tree, double reach_m)
      : grid_ (grid)
      , tree_ (tree)
      , reach_m_ (reach_m)
  {}

  /** \brief Call \a visit (i, next, nearest, distance) for voxels i of a row, of which those behind i up to
   * \a next are out of reach. Far away there is no nearest point, and the distance is only a lower bound. */
  template <typename Visit> void walk (int first, int last, int j, int k, Visit&& visit)
  {
    constexpr double view_vox = 4.0; // searching farther takes longer than the leaps save
    const double view_m = reach_m_ + view_vox * grid_.voxel_size_m;
    for (int i = first; i < last;)
    {
      const NearestPoint nearest = tree_.nearest (grid_.center (i, j, k), view_m, hint_);
      const bool found = std::isfinite (nearest.squared_m2);
      if (found)
        hint_ = nearest.triangle;
      const double distance_m = (found ? std::sqrt (nearest.squared_m2) : view_m);
      const double leap = std::floor (std::max (0.0, distance_m - reach_m_) / grid_.voxel_size_m) + 1.0;
      const int next = static_cast<int> (std::min (static_cast<double> (last), i + leap));
      visit (i, next, nearest, distance_m);
      i = next;
    }
  }

private:
  const VoxelGrid& grid_;
  const TriangleTree& tree_;
  double reach_m_;
  std::uint32_t hint_ = 0;
};

// ---- Values -------------------------------------------------------------------------------------

/** \brief What is known of a voxel near the next one. */
struct KnownVoxel
{
  Eigen::Vector3i voxel = Eigen::Vector3i::Zero ();
  double distance_m = -std::numeric_limits<double>::infinity (); ///< at least
  float sign = 1.0f;
};

/** \brief The sign of a closed surface at a voxel: -1 inside. \param[in] known a voxel near it, or any other */
float
signAt (const SearchableSurface& body, const VoxelGrid& grid, const Eigen::Vector3i& voxel, const NearestPoint& nearest,
        double distance_m, const KnownVoxel& known)
{
  if (const double side = body.side (nearest); side != 0.0)
    return side > 0.0 ? 1.0f : -1.0f;
  // Too far from the surface, both of them together, for it to pass between them?
  if (known.distance_m + distance_m > grid.voxel_size_m * (voxel - known.voxel).cast<double> ().norm ())
    return known.sign;
  const Eigen::Vector3d p = grid.center (voxel.x (), voxel.y (), voxel.z ());
  if (!std::isfinite (nearest.squared_m2))
    if (const double side = body.side (body.tree.nearest (p)); side != 0.0)
      return side > 0.0 ? 1.0f : -1.0f;
  return body.isInMatter (p) ? -1.0f : 1.0f;
}

/** \brief Lower the values to the signed distance of a closed surface. */
void
addBody (const SearchableSurface& body, double band_m, int threads, SignedDistanceField& field)
{
  const VoxelGrid& grid = field.grid;
  const VoxelRange range = (body.is_room ? VoxelRange{Eigen::Vector3i::Zero (), grid.dims}
                                         : voxelsAround (grid, body.box, band_m));
  forEachSlice (range, threads, [&] (int k) {
    RowWalker walker (grid, body.tree, band_m);
    KnownVoxel row_begin;
    for (int j = range.first.y (); j < range.last.y (); ++j)
    {
      KnownVoxel known = row_begin;
      walker.walk (range.first.x (), range.last.x (), j, k,
                   [&] (int i, int next, const NearestPoint& nearest, double distance_m) {
                     const Eigen::Vector3i voxel (i, j, k);
                     known = {voxel, distance_m, signAt (body, grid, voxel, nearest, distance_m, known)};
                     if (i == range.first.x ())
                       row_begin = known;
                     const float value = known.sign * static_cast<float> (std::min (distance_m, band_m));
                     for (int n = i; n < next; ++n)
                     {
                       float& lowest = field.values[grid.index (n, j, k)];
                       lowest = std::min (lowest, value);
                     }
                   });
    }
  });
}

/** \brief Lower the values to those of open surfaces where these say something, and fill in \a supported. */
void
addSheets (const SearchableSurface& sheets, double band_m, int threads, SignedDistanceField& field)
{
  const VoxelGrid& grid = field.grid;
  const auto band = static_cast<float> (band_m);
  field.supported.resize (grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
    field.supported[n] = field.values[n] < band; // by closed bodies
  // Neighbours of supported voxels share in interpolation, so they have to be on the right side too.
  const double reach_m = band_m + 2.0 * grid.voxel_size_m;
  const VoxelRange range = voxelsAround (grid, sheets.box, reach_m);
  forEachSlice (range, threads, [&] (int k) {
    RowWalker walker (grid, sheets.tree, reach_m);
    for (int j = range.first.y (); j < range.last.y (); ++j)
      walker.walk (range.first.x (), range.last.x (), j, k,
                   [&] (int i, int, const NearestPoint& nearest, double distance_m) {
                     const std::size_t n = grid.index (i, j, k);
                     const bool says = distance_m <= band_m && sheets.normals.isRegular (nearest);
                     if (distance_m > reach_m || (!says && field.supported[n] != 0))
                       return;
                     const auto distance = static_cast<float> (std::min (distance_m, band_m));
                     const float value = (sheets.normals.side (nearest) < 0.0 ? -distance : distance);
                     field.values[n] = std::min (field.values[n], value);
                     field.supported[n] = says || field.supported[n] != 0;
                   });
  });
}

void
check (const TriangleMesh& mesh, const VoxelGrid& grid, double band_m)
{
  checkMesh (mesh);
  if (mesh.empty ())
    throw InvalidArgument ("sampleSignedDistance: the mesh has no triangles");
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle)
      if (!mesh.vertices[v].allFinite ())
        throw InvalidArgument ("sampleSignedDistance: vertex " + std::to_string (v) + " of the mesh is not finite");
  if (grid.dims.minCoeff () < 1)
    throw InvalidArgument ("sampleSignedDistance: the grid must have at least one voxel along each axis");
  if (!(grid.voxel_size_m > 0.0 && std::isfinite (grid.voxel_size_m)) || !grid.origin_m.allFinite ())
    throw InvalidArgument ("sampleSignedDistance: the grid's voxel size must be positive and its origin finite");
  if (!(band_m > 0.0 && std::isfinite (band_m)))
    throw InvalidArgument ("sampleSignedDistance: the band must be a positive number of metres, but is " +
                           std::to_string (band_m));
}

} // namespace

SignedDistanceField
sampleSignedDistance (const TriangleMesh& mesh, const VoxelGrid& grid, double band_m, int threads)
{
  check (mesh, grid, band_m);
  const TriangleMesh clean = dropBackToBack (cleanMesh (mesh));
  const MeshBodies division = divideBodies (clean);
  if (division.bodies.empty () && division.sheets.empty ())
    throw InvalidArgument ("sampleSignedDistance: the mesh bounds nothing, all its triangles are without area or "
                           "lie back to back");
  SignedDistanceField field;
  field.grid = grid;
  field.values.assign (grid.size (), static_cast<float> (band_m));
  for (const auto& triangles : division.bodies)
    addBody (SearchableSurface (clean, triangles), band_m, threads, field);
  if (!division.sheets.empty ())
    addSheets (SearchableSurface (clean, division.sheets), band_m, threads, field);
  return field;
}

} // namespace pcl::cosection
