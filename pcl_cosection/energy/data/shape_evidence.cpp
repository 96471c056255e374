// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "shape_evidence.h"

#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int reach = 3;           // voxels, of a query for normals
constexpr float along_axis = 0.5f; // least component of a point's normal along the axis of its bin
constexpr float alike = 0.3f;      // least component of a queried normal along the axis of an occupied bin

} // namespace

ShapeEvidence::ShapeEvidence (const VoxelGrid& grid, const CoSectionOptions& options, bool carve)
    : grid_ (grid)
    , options_ (options)
    , hull_ (grid, options.threads)
{
  if (carve)
    carving_.emplace (grid, options.revise_votes, options.threads);
  clearPoints ();
}

ShapeEvidence::ShapeEvidence (const VoxelGrid& grid, const VoxelGrid& whole, const CoSectionOptions& options)
    : grid_ (grid)
    , options_ (options)
    , hull_ (grid, whole, options.threads)
{}

void
ShapeEvidence::clearPoints ()
{
  data_.weight.assign (grid_.size (), 0.0f);
  data_.weighted_target.assign (grid_.size (), 0.0f);
  data_.count.assign (grid_.size (), 0.0f);
}

void
ShapeEvidence::addView (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, bool silhouettes, int body)
{
  hull_.add (view, T_grid_sensor, body);
  if (!carving_ || !silhouettes)
    return;
  carving_->add (view, T_grid_sensor, body);
  seen_ = true;
}

NormalBinOccupancy::NormalBinOccupancy (const VoxelGrid& grid, const std::vector<OrientedPoint>& points)
    : grid_ (grid)
    , ways_ (grid.size (), 0)
{
  for (const OrientedPoint& point : points)
    if (const auto at = grid.nearest (point.position.cast<double> ()))
      for (int axis = 0; axis < 3; ++axis)
        if (std::abs (point.normal[axis]) >= along_axis)
          ways_[grid.index (at->x (), at->y (), at->z ())] |= static_cast<std::uint8_t> (
              1 << (2 * axis + (point.normal[axis] < 0.0f)));
}

bool
NormalBinOccupancy::face (const Eigen::Vector3f& position, const Eigen::Vector3f& normal) const
{
  unsigned wanted = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs (normal[axis]) > alike)
      wanted |= 1u << (2 * axis + (normal[axis] < 0.0f));
  const Eigen::Vector3i at = grid_.toVoxel (position.cast<double> ()).array ().round ().cast<int> ();
  const Eigen::Vector3i first = (at.array () - reach).max (0);
  const Eigen::Vector3i last = (at.array () + reach).min (grid_.dims.array () - 1);
  for (int k = first.z (); k <= last.z (); ++k)
    for (int j = first.y (); j <= last.y (); ++j)
      for (int i = first.x (); i <= last.x (); ++i)
        if (ways_[grid_.index (i, j, k)] & wanted)
          return true;
  return false;
}

} // namespace pcl::cosection
