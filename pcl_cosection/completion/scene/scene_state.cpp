// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_state.h"

#include <utility>

namespace pcl::cosection {

void
BodyState::restart (const VoxelGrid& new_grid, const CoSectionOptions& new_options, bool carve)
{
  const bool same_lattice = grid && grid->voxel_size_m == new_grid.voxel_size_m;
  solution = same_lattice ? startFrom (solution, *grid, new_grid) : BodySolution ();
  grid = new_grid;
  options = new_options;
  evidence = std::make_unique<ShapeEvidence> (new_grid, new_options, carve);
  points_read = 0;
  views_read = 0;
}

void
BodyState::readAgain ()
{
  if (grid)
    restart (VoxelGrid (*grid), CoSectionOptions (options), evidence && evidence->carves ());
  hidden.clear ();
  outliers.clear ();
  wall_m = 0.0;
}

void
BodyState::readPointsAgain ()
{
  if (evidence)
    evidence->clearPoints ();
  points_read = 0;
  hidden.clear ();
}

} // namespace pcl::cosection
