// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_hull.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float least_free_vox = 0.25f;    // least distance of a voxel seen free from the surface of the hull
constexpr float below_plane_vox = 1.0f;    // the uncertainty of a plane
constexpr float seed_reach_vox = 3.0f;     // voxels so near to points are seeds of the hull ...
constexpr float low_seed_reach_vox = 1.0f; // ... in the layer on a plane, voxels so near
// Connected components pass only through voxels so deep: the thin rays of single pixels without a reading do not count.
constexpr float core_depth_vox = 2.0f;
constexpr float around_core_vox = 4.0f; // voxels so near to the core belong to the hull: the corners of its cubes do
constexpr float layer_reach = 1.25f;    // of its thickness: how far the layer on a plane belongs to the hull above it
constexpr float far_vox = 3.0f;         // distances are clamped to this
constexpr float border_vox = 2.0f;      // distance of a closed surface from the border of its volume
constexpr float beside_vox = 1.5f;      // distance within which free space or a plane counts as bounding the surface

/** \brief Height above the lowest of the planes, voxels. */
float
heightAbove (const std::vector<Eigen::Vector4d>& planes, const VoxelGrid& grid, const Eigen::Vector3d& p)
{
  double lowest_m = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : planes)
    lowest_m = std::min (lowest_m, plane.head<3> ().dot (p) + plane[3]);
  return static_cast<float> (lowest_m / grid.voxel_size_m);
}

/** \brief Call f (n, i, j, k) for every voxel; threads divide the planes of the grid. */
template <typename Function>
void
forEachVoxel (const VoxelGrid& grid, int threads, Function&& f)
{
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    std::size_t n = grid.index (0, 0, k);
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i, ++n)
        f (n, i, j, k);
  });
}

/** \brief The wanted voxels (not 0) that are connected with a seed by faces; all seeds are among them. */
std::vector<std::uint8_t>
connectedWith (const std::vector<std::uint8_t>& seeds, const std::vector<std::uint8_t>& wanted,
               const Eigen::Vector3i& dims)
{
  std::vector<std::uint8_t> reached = seeds;
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < seeds.size (); ++n)
    if (seeds[n])
      open.push_back (n);
  const std::array<std::size_t, 3> steps = {1, static_cast<std::size_t> (dims.x ()),
                                            static_cast<std::size_t> (dims.x ()) * dims.y ()};
  while (!open.empty ())
  {
    const std::size_t n = open.back ();
    open.pop_back ();
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto at = static_cast<int> (n / steps[axis] % dims[axis]);
      const auto visit = [&] (std::size_t next) {
        if (!wanted[next] || reached[next])
          return;
        reached[next] = 1;
        open.push_back (next);
      };
      if (at > 0)
        visit (n - steps[axis]);
      if (at + 1 < dims[axis])
        visit (n + steps[axis]);
    }
  }
  return reached;
}

} // namespace

ObjectHull::ObjectHull (const VoxelGrid& grid, const CoSectionOptions& options)
    : grid_ (grid)
    , options_ (options)
    , votes_ (grid, options.threads)
{
  if (options.carve_free_space)
    carving_.emplace (grid, options.revise_votes, options.threads);
}

void
ObjectHull::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_object_sensor)
{
  votes_.add (view, T_object_sensor);
  if (carving_)
    carving_->add (view, T_object_sensor);
}

std::vector<float>
ObjectHull::distanceToFree () const
{
  std::vector<float> value = carving_ ? carving_->lowerBounds (true) : std::vector<float> (grid_.size (), -0.5f);
  forEachVoxel (grid_, options_.threads, [&] (std::size_t n, int, int, int) {
    if (free_space_[n])
      value[n] = std::max (value[n], carving_ ? least_free_vox : 0.5f);
  });
  return value;
}

void
ObjectHull::finish (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector4d>& planes,
                    double layer_m)
{
  planes_ = planes;
  const int threads = options_.threads;
  free_space_ = votes_.freeSpace (options_.revise_votes);
  std::vector<float> value = distanceToFree ();

  std::vector<std::uint8_t> data (grid_.size (), 0);
  for (const OrientedPoint& point : points)
    if (const auto at = grid_.nearest (point.position.cast<double> ()))
      data[grid_.index (at->x (), at->y (), at->z ())] = 1;
  data_distance_vox_ = distanceTransform (grid_.dims, data, threads);

  const auto layer_vox = static_cast<float> (layer_m / grid_.voxel_size_m);
  std::vector<std::uint8_t> outside (grid_.size ()), seeds (grid_.size ()), low (grid_.size ());
  forEachVoxel (grid_, threads, [&] (std::size_t n, int i, int j, int k) {
    const float height_vox = heightAbove (planes, grid_, grid_.center (i, j, k));
    value[n] = std::max (value[n], -below_plane_vox - height_vox);
    outside[n] = value[n] >= 0.0f;
    low[n] = height_vox < layer_vox;
    seeds[n] = !outside[n] && data_distance_vox_[n] <= (low[n] ? low_seed_reach_vox : seed_reach_vox);
  });
  std::vector<std::uint8_t> core (grid_.size ());
  {
    const std::vector<float> depth_vox = distanceTransform (grid_.dims, outside, threads);
    forEachVoxel (grid_, threads,
                  [&] (std::size_t n, int, int, int) { core[n] = depth_vox[n] > core_depth_vox && !low[n]; });
  }
  const std::vector<std::uint8_t> kept = connectedWith (seeds, core, grid_.dims);
  const std::vector<float> away_vox = distanceTransform (grid_.dims, kept, threads);

  hull_.grid = grid_;
  hull_.values.resize (grid_.size ());
  forEachVoxel (grid_, threads, [&] (std::size_t n, int i, int j, int k) {
    const int border = std::min ({i, j, k, grid_.dims.x () - 1 - i, grid_.dims.y () - 1 - j, grid_.dims.z () - 1 - k});
    const float reach_vox = low[n] ? std::max (around_core_vox, layer_reach * layer_vox) : around_core_vox;
    const float outside_vox = std::max ({value[n], away_vox[n] - reach_vox, border_vox - static_cast<float> (border)});
    hull_.values[n] = static_cast<float> (std::min (outside_vox, far_vox) * grid_.voxel_size_m);
  });
}

TriangleMesh
ObjectHull::meshWith (const SignedDistanceField& body) const
{
  SignedDistanceField both = hull_;
  forEachVoxel (grid_, options_.threads, [&] (std::size_t n, int i, int j, int k) {
    if (const auto value = body.sample (grid_.center (i, j, k)))
      both.values[n] = std::min (both.values[n], *value);
  });
  return meshOf (both);
}

TriangleMesh
ObjectHull::meshOf (const SignedDistanceField& field) const
{
  IsoSurfaceOptions iso;
  iso.closed = true;
  iso.threads = options_.threads;
  TriangleMesh mesh = extractIsoSurface (field, iso);
  attachEvidence (mesh);
  return mesh;
}

void
ObjectHull::attachEvidence (TriangleMesh& mesh) const
{
  constexpr double confidence_scale_vox = 5.0;
  const std::vector<float> free_distance_vox = distanceTransform (grid_.dims, free_space_, options_.threads);
  mesh.confidence.resize (mesh.vertices.size ());
  mesh.provenance.resize (mesh.vertices.size ());
  parallelFor (0, static_cast<int> (mesh.vertices.size ()), options_.threads, [&] (int v) {
    const Eigen::Vector3d p = mesh.vertices[v].cast<double> ();
    const Eigen::Vector3i at = *grid_.nearest (p);
    const std::size_t n = grid_.index (at.x (), at.y (), at.z ());
    Provenance provenance = Provenance::Inferred;
    if (data_distance_vox_[n] <= beside_vox)
      provenance = Provenance::Observed;
    else if (std::abs (heightAbove (planes_, grid_, p)) <= beside_vox)
      provenance = Provenance::Intersection;
    else if (free_distance_vox[n] <= beside_vox)
      provenance = Provenance::Hull;
    mesh.provenance[v] = static_cast<std::uint8_t> (provenance);
    mesh.confidence[v] = static_cast<float> (std::exp (-data_distance_vox_[n] / confidence_scale_vox));
  });
}

} // namespace pcl::cosection
