// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_state.h"

namespace pcl::cosection
{

void
IncrementalState::restart (const VoxelGrid& grid, const CoSectionOptions& options, bool carve)
{
  auto shape = std::make_unique<ShapeVolume> (grid, options);
  if (volume && volume->grid ().voxel_size_m == grid.voxel_size_m)
    shape->startFrom (*volume);
  volume = std::move (shape);
  evidence = std::make_unique<ShapeEvidence> (grid, options, carve);
  points_read = 0;
  views_read = 0;
}

void
IncrementalState::readAgain ()
{
  if (volume)
    restart (VoxelGrid (volume->grid ()), CoSectionOptions (volume->options ()), evidence && evidence->carves ());
  hidden.clear ();
  outlier.clear ();
  wall_m = 0.0;
}

void
IncrementalState::readPointsAgain ()
{
  if (evidence)
    evidence->clearPoints ();
  points_read = 0;
  hidden.clear ();
}

} // namespace pcl::cosection
