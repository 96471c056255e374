// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/energy/body_solution.h"
#include "pcl_cosection/energy/data/shape_evidence.h"
#include "pcl_cosection/priors/occlusion_map.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief How a scene is completed. */
enum class CompletionMode
{
  Once,        ///< evidence is given up once it has been used
  Incremental, ///< the state is for the next update
};

/** \brief The state of one body between updates: its grid, what has been read of the scene's points and views, and the
 * last solution. */
struct BodyState
{
  std::optional<VoxelGrid> grid;
  CoSectionOptions options;                // of the scene, with the body's own Gaussians and tolerance
  std::unique_ptr<ShapeEvidence> evidence; // null before there is a grid, and once it has been used up
  BodySolution solution;
  OcclusionMap hidden;          // what views hide of an object
  double wall_m = 0.0;          // wall thickness of a vessel; 0 for other shapes
  int updates_without_wall = 0; // since the last that found a wall
  std::size_t points_read = 0;
  std::size_t views_read = 0;
  std::vector<bool> outliers; // which points are left out, of those known at the last update

  /** \brief Read everything again, on a grid of the same lattice or another; on the same lattice the solution is kept
   * as a start. */
  void restart (const VoxelGrid& new_grid, const CoSectionOptions& new_options, bool carve);

  /** \brief Forget all that was read; the grid and the solution stay. */
  void readAgain ();

  /** \brief Forget what was made of points. */
  void readPointsAgain ();
};

/** \brief What remains from one update to the next. */
struct SceneState
{
  std::map<int, BodyState> objects; // by id
  BodyState background;             // if all of it is completed
};

} // namespace pcl::cosection
