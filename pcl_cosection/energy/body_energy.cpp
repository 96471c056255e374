// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_energy.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include "pcl_cosection/energy/solver/solver_detail.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float observed_weight = 0.3f; // sum of weights that makes a voxel one with data: a point within 1.1 sigma
constexpr double continued_plane_weight = 0.5;  // of the data term on a continued plane: that of dense measurements
constexpr double continued_plane_gap_vox = 2.0; // planes are continued where no data is nearer
constexpr std::size_t bytes_per_voxel = 95;
constexpr float carving_reach_vox = 1.5f; // from the boundary of free space into the hull
// Local solutions after new evidence extend so far beyond the supported region.
constexpr double follow_margin_vox = 3.0;

/** \brief Call f (index) for every voxel; threads divide the planes of the grid. */
template <typename Function>
void
forEachVoxel (const BodyEnergy& energy, Function&& f)
{
  const std::size_t plane = energy.grid.index (0, 0, 1);
  parallelFor (0, energy.grid.dims.z (), threadsForVoxels (energy.options.threads, energy.grid.size ()), [&] (int k) {
    for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
      f (n);
  });
}

/** \brief Equation (2): W and C, without data in free space. */
void
addDataTerm (const ImlsDataTerm& data, BodyEnergy& energy)
{
  EnergyProblem& problem = energy.problem;
  data.average (energy.options.weighting, problem.weight, problem.weighted_target, energy.options.threads);
  energy.data.resize (energy.grid.size ());
  forEachVoxel (energy, [&] (std::size_t n) {
    if (energy.free_space[n])
      problem.weight[n] = problem.weighted_target[n] = 0.0f;
    energy.data[n] = !energy.free_space[n] && data.weight[n] >= observed_weight;
  });
  energy.data_distance_vox = distanceTransform (energy.grid.dims, energy.data, energy.options.threads);
}

/** \brief Add a data term where a support plane continues under or behind the objects that hide it. */
void
continuePlane (const PlaneContinuation& continuation, BodyEnergy& energy)
{
  const VoxelGrid& grid = energy.grid;
  const double sigma_vox = energy.options.sigma_vox;
  parallelFor (0, grid.dims.z (), energy.options.threads, [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        if (energy.free_space[n] || energy.data_distance_vox[n] < continued_plane_gap_vox)
          continue;
        const Eigen::Vector3d p = grid.center (i, j, k);
        const double s = heightOver (continuation.plane, p) / grid.voxel_size_m;
        if (std::abs (s) > 3.0 * sigma_vox || !continuation.region.contains (p))
          continue;
        const double w = continued_plane_weight * std::exp (-s * s / (sigma_vox * sigma_vox));
        energy.problem.weight[n] = static_cast<float> (w);
        energy.problem.weighted_target[n] = static_cast<float> (w * s);
        if (std::abs (s) <= 1.0)
          energy.data[n] = energy.continued[n] = 1;
      }
  });
}

/** \brief Add the bounds of the hull constraint, equation (3). */
void
addHullBound (BodyEnergy& energy)
{
  const CoSectionOptions& options = energy.options;
  if (!options.use_hull || options.beta_hull <= 0.0)
    return;
  const std::vector<float> distance = hullDistance (energy.grid.dims, energy.free_space, options.threads);
  energy.problem.exterior.resize (energy.grid.size ());
  forEachVoxel (energy, [&] (std::size_t n) {
    const float distance_vox = options.hull_distance == HullDistance::Exact ? distance[n] : 1.0f;
    energy.problem.exterior[n] = energy.free_space[n]
                                     ? LowerBound (distance_vox, static_cast<float> (options.beta_hull))
                                     : LowerBound ();
  });
}

SolverOptions
solverOptions (const CoSectionOptions& options)
{
  SolverOptions solver = options.solver;
  solver.threads = options.threads;
  return solver;
}

} // namespace

BodyEnergy
makeBodyEnergy (const ShapeEvidence& evidence, const std::vector<PlaneContinuation>& planes)
{
  BodyEnergy energy;
  energy.grid = evidence.grid ();
  energy.options = evidence.options ();
  energy.problem.dims = energy.grid.dims;
  energy.problem.alpha = energy.options.alpha;
  energy.free_space = evidence.freeSpace ();
  energy.empty = energy.free_space;
  energy.carved = evidence.carvedBounds ();
  addDataTerm (evidence.data (), energy);
  energy.continued.assign (planes.empty () ? 0 : energy.grid.size (), 0);
  for (const PlaneContinuation& plane : planes)
    continuePlane (plane, energy);
  if (!planes.empty ())
    energy.data_distance_vox = distanceTransform (energy.grid.dims, energy.data, energy.options.threads);
  addHullBound (energy);
  return energy;
}

BodyEnergy
withExpectedPoints (const BodyEnergy& energy, const std::vector<OrientedPoint>& points)
{
  BodyEnergy with = energy;
  ImlsDataTerm term;
  term.add (energy.grid, points, energy.options.sigma_vox, energy.options.threads);
  std::vector<float> weight, target;
  term.average (energy.options.weighting, weight, target, energy.options.threads);
  forEachVoxel (energy, [&] (std::size_t n) {
    if (energy.data[n] || energy.free_space[n] || term.weight[n] < observed_weight)
      return;
    with.problem.weight[n] = weight[n];
    with.problem.weighted_target[n] = target[n];
    with.data[n] = 1;
  });
  return with;
}

std::size_t
estimateBytes (const VoxelGrid& grid)
{
  return grid.size () * bytes_per_voxel;
}

SignedDistanceField
measuredField (const BodyEnergy& energy)
{
  SignedDistanceField field;
  field.grid = energy.grid;
  field.values.resize (energy.grid.size (), 0.0f);
  field.supported = energy.data;
  const EnergyProblem& problem = energy.problem;
  for (std::size_t n = 0; n < energy.grid.size (); ++n)
    if (energy.data[n])
      field.values[n] = static_cast<float> (problem.weighted_target[n] / problem.weight[n] * energy.grid.voxel_size_m);
  return field;
}

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

SolverSummary
followSolution (const BodyEnergy& energy, BodySolution& solution, const ProgressCallback& progress,
                double& solved_share)
{
  const SolverOptions solver = solverOptions (energy.options);
  QuarterResolution quarter;
  std::swap (quarter, solution.quarter); // returned at the end
  std::optional<LocalSolution> local;
  if (quarter.update (energy.problem, solver, solution.u, progress) && solution.solved_fully)
  {
    const auto reach_vox = static_cast<float> (energy.options.max_bound_vox + follow_margin_vox);
    local = solveNearData (energy.problem, solver, {energy.data_distance_vox, reach_vox}, solution.u, progress);
  }
  solved_share = local ? static_cast<double> (local->voxels) / static_cast<double> (energy.grid.size ()) : 1.0;
  SolverSummary summary = local ? local->summary : solve (energy, Resolution::Full, solution, progress);
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
  SignedDistanceField field;
  field.grid = energy.grid;
  field.values.resize (energy.grid.size ());
  field.supported.resize (energy.grid.size ());
  forEachVoxel (energy, [&] (std::size_t n) {
    field.values[n] = static_cast<float> (carvedValue (energy, solution, n) * energy.grid.voxel_size_m);
    field.supported[n] = !energy.free_space[n] && (energy.data_distance_vox[n] <= energy.options.max_bound_vox ||
                                                   (!energy.expected.empty () && energy.expected[n]));
  });
  return field;
}

} // namespace pcl::cosection
