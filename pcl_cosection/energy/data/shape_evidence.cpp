// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "shape_evidence.h"

namespace pcl::cosection {

ShapeEvidence::ShapeEvidence (const VoxelGrid& grid, const CoSectionOptions& options, bool carve)
    : grid_ (grid)
    , options_ (options)
    , hull_ (grid, options.threads)
{
  if (carve)
    carving_.emplace (grid, options.revise_votes, options.threads);
  clearPoints ();
}

void
ShapeEvidence::clearPoints ()
{
  data_.weight.assign (grid_.size (), 0.0f);
  data_.weighted_target.assign (grid_.size (), 0.0f);
  data_.count.assign (grid_.size (), 0.0f);
}

void
ShapeEvidence::addPoints (const std::vector<OrientedPoint>& points)
{
  data_.add (grid_, points, options_.sigma_vox, options_.threads);
}

void
ShapeEvidence::addView (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor, bool silhouettes)
{
  hull_.add (view, T_grid_sensor);
  if (!carving_ || !silhouettes)
    return;
  carving_->add (view, T_grid_sensor);
  seen_ = true;
}

std::vector<float>
ShapeEvidence::carvedBounds () const
{
  return carving_ && seen_ ? carving_->lowerBounds () : std::vector<float> ();
}

} // namespace pcl::cosection
