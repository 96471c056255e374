// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_energy.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include "pcl_cosection/energy/solver/solver_detail.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr float observed_weight = 0.3f; // sum of weights that makes a voxel one with data: a point within 1.1 sigma
constexpr double continued_plane_weight = 0.5;  // of the data term on a continued plane: that of dense measurements
constexpr double continued_plane_gap_vox = 2.0; // planes are continued where no data is nearer
constexpr std::size_t bytes_per_voxel = 94;

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
        const double s = (continuation.plane.head<3> ().dot (p) + continuation.plane[3]) / grid.voxel_size_m;
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

} // namespace

bool
BodyEnergy::hasData () const
{
  return std::any_of (data.begin (), data.end (), [] (std::uint8_t d) { return d != 0; });
}

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
  field.supported.resize (energy.grid.size (), 0);
  const EnergyProblem& problem = energy.problem;
  for (std::size_t n = 0; n < energy.grid.size (); ++n)
    if (energy.data[n])
    {
      field.values[n] = static_cast<float> (problem.weighted_target[n] / problem.weight[n] * energy.grid.voxel_size_m);
      field.supported[n] = 1;
    }
  return field;
}

} // namespace pcl::cosection
