// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/body_solution.h"
#include "pcl_cosection/energy/data/shape_evidence.h"
#include "pcl_cosection/priors/occlusion_map.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief How a scene is completed. */
enum class CompletionMode
{
  Once,        ///< evidence is freed after use
  Incremental, ///< the state is kept for the next update
};

/** \brief The state of one body between updates: its grid, the evidence of the points and views read so far, and the
 * last solution. */
struct BodyState
{
  std::optional<VoxelGrid> grid;
  CoSectionOptions options;                // of the scene, with the body's own Gaussians and tolerance
  std::unique_ptr<ShapeEvidence> evidence; // null before there is a grid, and after use in the mode Once
  BodySolution solution;
  OcclusionMap hidden;          // occlusion of the object's volume by its views
  double wall_m = 0.0;          // wall thickness of a vessel; 0 for other shapes
  int updates_without_wall = 0; // since the last one that found a wall
  std::size_t points_read = 0;
  std::size_t views_read = 0;
  std::vector<bool> outliers; // whether a point is left out; for the points of the last update

  /** \brief Change the grid and read everything again. The solution is kept as a start if the lattice is the same. */
  void restart (const VoxelGrid& new_grid, const CoSectionOptions& new_options, bool carve);

  /** \brief Read all points and views again; the grid and the solution stay. */
  void readAgain ();

  /** \brief Read all points again. */
  void readPointsAgain ();
};

/** \brief The incremental state of a scene, kept from one update to the next. */
struct SceneState
{
  std::map<int, BodyState> objects; // by id
  BodyState background;             // if all of it is completed
};

} // namespace pcl::cosection
