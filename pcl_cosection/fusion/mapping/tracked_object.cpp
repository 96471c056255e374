// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tracked_object.h"

#include "pcl_cosection/common/trimmed_box.h"

#include <pcl/cosection/common/camera.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double placing_share = 0.1; // of the points, at either end of each axis
constexpr double edge_factor = 2.0;
constexpr double growing_share = 0.02;
constexpr double margin_share = 0.1; // of a volume's side, around its points
constexpr int growth_step = 8;       // voxels
constexpr std::size_t min_points = 20;
constexpr double surface_share = 0.2; // of a volume's side: how far an object's surface is from its centre

Eigen::AlignedBox3d
boxWithout (double share, const std::vector<Eigen::Vector3f>& points)
{
  return trimmedBox<double> (points, share, [] (const Eigen::Vector3f& p) { return p; });
}

} // namespace

void
TrackedObject::moveTo (const Eigen::Isometry3d& T_world)
{
  const VoxelGrid& grid = volume->grid ();
  const Eigen::Vector3d centre = grid.origin_m + 0.5 * grid.voxel_size_m * grid.dims.cast<double> ();
  const double radius = surface_share * grid.voxel_size_m * grid.dims.maxCoeff ();
  const double turn = Eigen::AngleAxisd (T_world.linear ().transpose () * T_world_rest.linear ()).angle ();
  const double moved = std::max ((T_world * centre - T_world_rest * centre).norm (), radius * turn);
  ++frames_at_rest;
  frames_away = moved > std::hypot (grid.voxel_size_m, depthNoiseSigma (range_m)) ? frames_away + 1 : 0;
  if (frames_away >= frames_of_motion)
  {
    T_world_rest = T_world;
    frames_at_rest = 0;
  }
  T_world_object = T_world;
}

void
TrackedObject::retire ()
{
  surface = volume->surfaceMesh ();
  volume.reset ();
  state = ObjectState::Retired;
}

std::optional<VoxelGrid>
placeObjectVolume (const std::vector<Eigen::Vector3f>& points, int resolution)
{
  if (points.size () < min_points)
    return std::nullopt;
  const Eigen::AlignedBox3d box = boxWithout (placing_share, points);
  const double edge = edge_factor * box.sizes ().maxCoeff ();
  if (!(edge > 0.0 && std::isfinite (edge)))
    return std::nullopt;
  VoxelGrid grid;
  grid.dims.setConstant (resolution);
  grid.voxel_size_m = edge / resolution;
  grid.origin_m = box.center () - Eigen::Vector3d::Constant (0.5 * grid.voxel_size_m * (resolution - 1));
  return grid;
}

bool
growObjectVolume (TsdfVolume& volume, const std::vector<Eigen::Vector3f>& points, int max_resolution)
{
  if (points.size () < min_points)
    return true;
  const VoxelGrid& grid = volume.grid ();
  const Eigen::AlignedBox3d box = boxWithout (growing_share, points);
  const Eigen::Array3d margin = margin_share * grid.dims.cast<double> ().array ();
  const Eigen::Array3d low = grid.toVoxel (box.min ()).array () - margin;
  const Eigen::Array3d high = grid.toVoxel (box.max ()).array () + margin;
  Eigen::Vector3i offset = Eigen::Vector3i::Zero ();
  Eigen::Vector3i dims = grid.dims;
  bool fits = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto steps = [] (double voxels) {
      return voxels > 0.0 ? growth_step * static_cast<int> (std::ceil (std::min (voxels, 1e6) / growth_step)) : 0;
    };
    const int room = std::max (0, max_resolution - grid.dims[axis]);
    const int before = steps (-low[axis]);
    const int after = steps (high[axis] - (grid.dims[axis] - 1));
    offset[axis] = std::min (before, room);
    const int behind = std::min (after, room - offset[axis]);
    fits = fits && offset[axis] == before && behind == after;
    dims[axis] += offset[axis] + behind;
  }
  if (dims != grid.dims)
    volume.grow (offset, dims);
  return fits;
}

double
volumeOverlap (const VoxelGrid& a, const Eigen::Isometry3d& T_world_a, const VoxelGrid& b,
               const Eigen::Isometry3d& T_world_b)
{
  constexpr int samples = 12; // along each axis
  const Eigen::Isometry3d T_b_a = T_world_b.inverse () * T_world_a;
  int inside = 0;
  for (int k = 0; k < samples; ++k)
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i)
      {
        const Eigen::Array3d share = (Eigen::Array3d (i, j, k) + 0.5) / samples;
        const Eigen::Vector3d p = a.origin_m +
                                  a.voxel_size_m * (share * a.dims.cast<double> ().array () - 0.5).matrix ();
        inside += b.nearest (T_b_a * p).has_value ();
      }
  const auto size = [] (const VoxelGrid& grid) {
    return static_cast<double> (grid.size ()) * std::pow (grid.voxel_size_m, 3);
  };
  const double common = size (a) * inside / (samples * samples * samples);
  return common / (size (a) + size (b) - common);
}

} // namespace pcl::cosection
