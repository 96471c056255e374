// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hull_constraint.h"

#include "pcl_cosection/view/visibility/projected_voxels.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int max_footprint = 12; // pixels

} // namespace

HullConstraint::HullConstraint (const VoxelGrid& grid, int threads)
    : grid_ (grid)
    , threads_ (threads)
    , votes_for_ (grid.size (), 0)
    , votes_against_ (grid.size (), 0)
{}

void
HullConstraint::add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor)
{
  const PinholeCamera& camera = view.view ().camera;
  const Eigen::Isometry3d T_sensor_grid = T_grid_sensor.inverse ();

  // The footprint at the nearest corner of the volume serves all its voxels.
  double nearest = std::numeric_limits<double>::infinity ();
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3i at ((corner & 1) ? grid_.dims.x () - 1 : 0, (corner & 2) ? grid_.dims.y () - 1 : 0,
                              (corner & 4) ? grid_.dims.z () - 1 : 0);
    nearest = std::min (nearest, (T_sensor_grid * grid_.center (at.x (), at.y (), at.z ())).z ());
  }
  const double focal = std::max (camera.fx, camera.fy);
  const double half_diagonal = 0.5 * std::sqrt (3.0) * grid_.voxel_size_m;
  const int radius = nearest > half_diagonal
                         ? std::min (max_footprint, static_cast<int> (std::ceil (half_diagonal * focal / nearest)))
                         : max_footprint;
  const std::vector<float> nearest_depth = view.nearestDepth (radius, projectedRegion (grid_, camera, T_grid_sensor));

  const auto vote = [] (std::uint8_t& votes) {
    if (votes < 255)
      ++votes;
  };
  forEachProjectedVoxel (grid_, camera, T_grid_sensor, threads_, [&] (const ProjectedVoxel& voxel) {
    const float depth = view.view ().depth[voxel.pixel];
    const double margin = freeSpaceMargin (depth, grid_.voxel_size_m);
    const PointVisibility visibility = compareWithReading (voxel.z, depth, margin);
    if (visibility == PointVisibility::AtSurface)
      vote (votes_against_[voxel.index]);
    else if (visibility == PointVisibility::Free && !view.atEdge (voxel.column, voxel.row) &&
             nearest_depth[voxel.pixel] - voxel.z > margin)
      vote (votes_for_[voxel.index]);
  });
}

std::vector<std::uint8_t>
HullConstraint::freeSpace (bool revise) const
{
  std::vector<std::uint8_t> free_space (votes_for_.size ());
  const std::size_t plane = static_cast<std::size_t> (grid_.dims.x ()) * grid_.dims.y ();
  parallelFor (0, grid_.dims.z (), threads_, [&] (int k) {
    for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
      free_space[n] = votes_for_[n] > (revise ? votes_against_[n] : 0);
  });
  return free_space;
}

std::vector<float>
hullDistance (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& free_space, int threads)
{
  std::vector<std::uint8_t> hull (free_space.size ());
  std::transform (free_space.begin (), free_space.end (), hull.begin (), [] (std::uint8_t free) { return free == 0; });
  std::vector<float> distance = distanceTransform (dims, hull, threads);
  parallelFor (0, dims.z (), threads, [&] (int k) {
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
      {
        // The nearest voxel outside the volume is straight across the nearest border.
        const int border = std::min ({i + 1, j + 1, k + 1, dims.x () - i, dims.y () - j, dims.z () - k});
        float& d = distance[(static_cast<std::size_t> (k) * dims.y () + j) * dims.x () + i];
        d = std::min (d, static_cast<float> (border));
      }
  });
  return distance;
}

} // namespace pcl::cosection
