// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "body_energy.h"
#include "pcl_cosection/energy/solver/local_solver.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <vector>

namespace pcl::cosection {

/** \brief How finely a body is solved. */
enum class Resolution
{
  Half, ///< voxels of twice the size: an intermediate step, eight times cheaper
  Full,
};

/** \brief The field that minimises a body's energy, and from which the next solve starts. Voxels of the body's grid. */
struct BodySolution
{
  std::vector<float> u;
  std::vector<float> half_u; // at half the resolution
  QuarterResolution quarter; // for followSolution ()
  bool solved_fully = false; // at full resolution

  /** \brief Whether this is a solution at this resolution, or a finer one. */
  bool has (Resolution resolution) const { return !u.empty () && (resolution == Resolution::Half || solved_fully); }
};

/** \brief A solution as a start on another grid of the same lattice; empty if it was not solved at full resolution. */
BodySolution startFrom (const BodySolution& solution, const VoxelGrid& from, const VoxelGrid& to);

/** \brief Minimise, from the last solution if there is one.
 * \throws Cancelled */
SolverSummary solve (const BodyEnergy& energy, Resolution resolution, BodySolution& solution,
                     const ProgressCallback& progress);

/** \brief Result of followSolution (). */
struct FollowSummary
{
  SolverSummary solver;
  double solved_share = 1.0; // part of the voxels that was solved at full resolution
};

/** \brief Minimise after more evidence, for a body whose field is used only near data: everywhere on voxels of four
 * times the size, and at full resolution near data that has changed. Calls solve () the first time, and if most has
 * changed.
 * \throws Cancelled */
FollowSummary followSolution (const BodyEnergy& energy, BodySolution& solution, const ProgressCallback& progress);

/** \brief The carved minimiser max (u, c) at a voxel, in voxels. */
float carvedValue (const BodyEnergy& energy, const BodySolution& solution, std::size_t voxel);

/** \brief The carved minimiser, supported near data where not seen free. Metres. */
SignedDistanceField solvedField (const BodyEnergy& energy, const BodySolution& solution);

} // namespace pcl::cosection
