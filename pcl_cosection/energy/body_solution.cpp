// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_solution.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/solver/local_solver.h"
#include "pcl_cosection/energy/solver/solver_detail.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float carving_reach_vox = 1.5f; // from the boundary of free space into the hull
// Local solutions after new evidence extend so far beyond the supported region.
constexpr double follow_margin_vox = 3.0;

SolverOptions
solverOptions (const CoSectionOptions& options)
{
  SolverOptions solver = options.solver;
  solver.threads = options.threads;
  return solver;
}

} // namespace

BodySolution
startFrom (const BodySolution& solution, const VoxelGrid& from, const VoxelGrid& to)
{
  BodySolution start;
  if (!solution.has (Resolution::Full))
    return start;
  const Eigen::Vector3i shift = ((to.origin_m - from.origin_m) / to.voxel_size_m).array ().round ().cast<int> ();
  start.u.resize (to.size ());
  for (int k = 0; k < to.dims.z (); ++k)
    for (int j = 0; j < to.dims.y (); ++j)
      for (int i = 0; i < to.dims.x (); ++i)
      {
        // Beyond the other grid: the value at its border plus the distance to it.
        const Eigen::Vector3i at = Eigen::Vector3i (i, j, k) + shift;
        const Eigen::Vector3i inside = at.cwiseMax (0).cwiseMin (from.dims - Eigen::Vector3i::Ones ());
        start.u[to.index (i, j, k)] = solution.u[from.index (inside.x (), inside.y (), inside.z ())] +
                                      static_cast<float> ((at - inside).cast<double> ().norm ());
      }
  start.solved_fully = true;
  if (to.origin_m == from.origin_m && to.dims == from.dims)
    start.quarter = solution.quarter;
  return start;
}

SolverSummary
solve (const BodyEnergy& energy, Resolution resolution, BodySolution& solution, const ProgressCallback& progress)
{
  const SolverOptions solver = solverOptions (energy.options);
  if (resolution == Resolution::Half &&
      solveAtHalfResolution (energy.problem, solver, solution.half_u, solution.u, progress))
    return {};
  std::vector<float> ().swap (solution.half_u);
  solution.solved_fully = true;
  return solve (energy.problem, solver, solution.u, progress);
}

FollowSummary
followSolution (const BodyEnergy& energy, BodySolution& solution, const ProgressCallback& progress)
{
  const SolverOptions solver = solverOptions (energy.options);
  QuarterResolution quarter;
  std::swap (quarter, solution.quarter); // returned at the end
  const bool follows = quarter.update (energy.problem, solver, solution.u, progress) && solution.solved_fully;
  FollowSummary summary;
  std::optional<LocalSolution> local;
  if (follows)
  {
    const auto reach_vox = static_cast<float> (energy.options.max_bound_vox + follow_margin_vox);
    local = solveNearData (energy.problem, solver, {energy.data_distance_vox, reach_vox}, solution.u, progress);
  }
  if (local)
    summary = {local->summary, static_cast<double> (local->voxels) / static_cast<double> (energy.grid.size ())};
  else
    summary.solver = solve (energy, Resolution::Full, solution, progress);
  solution.quarter = std::move (quarter);
  return summary;
}

float
carvedValue (const BodyEnergy& energy, const BodySolution& solution, std::size_t voxel)
{
  if (energy.carved.empty () || energy.carved[voxel] <= -carving_reach_vox)
    return solution.u[voxel];
  return std::max (solution.u[voxel], energy.carved[voxel]);
}

SignedDistanceField
solvedField (const BodyEnergy& energy, const BodySolution& solution)
{
  const VoxelGrid& grid = energy.grid;
  SignedDistanceField field;
  field.grid = grid;
  field.values.resize (grid.size ());
  field.supported.resize (grid.size ());
  const std::size_t plane = grid.index (0, 0, 1);
  parallelFor (0, grid.dims.z (), threadsForVoxels (energy.options.threads, grid.size ()), [&] (int k) {
    for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
    {
      field.values[n] = static_cast<float> (carvedValue (energy, solution, n) * grid.voxel_size_m);
      field.supported[n] = !energy.free_space[n] && energy.data_distance_vox[n] <= energy.options.max_bound_vox;
    }
  });
  return field;
}

} // namespace pcl::cosection
