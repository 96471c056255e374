// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/solver.h>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief Where a field is to minimise an energy: the voxels whose distance to data is no more than a reach. */
struct NearData
{
  const std::vector<float>& distance_vox; ///< one per voxel
  float reach_vox;
};

/** \brief What a local solve did. */
struct LocalSolution
{
  SolverSummary summary;  ///< its iterations: the most that a place took; without energies on the way
  std::size_t voxels = 0; ///< that were solved
};

/** \brief Minimise a problem near data, where the given field does not.
 *
 * The grid is divided into bricks. Those with a voxel near data that a step of Jacobi's method would move by more than
 * a tolerance are united to boxes, and these are solved with a margin around them, beyond which the field is held
 * fixed; all from the same field (restricted additive Schwarz method: X.-C. Cai and M. Sarkis, SIAM Journal on
 * Scientific Computing 1999). Where boxes then disagree, or a margin was too small, they are solved once more. What is
 * far from data must be right beforehand, as is a start from coarser voxels.
 *
 * \param[in,out] u one value per voxel, voxels
 * \return nothing, and nothing is done, if the boxes are so large that solve () takes no longer
 * \throws Cancelled if \a progress returns false */
std::optional<LocalSolution> solveNearData (const EnergyProblem& problem, const SolverOptions& options,
                                            const NearData& near, std::vector<float>& u,
                                            const ProgressCallback& progress);

/** \brief A field on voxels of four times the size that goes with one at full resolution while the problem changes:
 * what the change makes of it is added to the other, which keeps its detail. As differences add up to one, errors of
 * many changes do not. */
class QuarterResolution
{
public:
  /** \param[in,out] u the minimiser before the change, then near the one after it, but for detail; if its size is
   * wrong, a start for solve ()
   * \return whether this followed a change; false the first time, and always if the solver has no such level
   * \throws Cancelled; then nothing was done, but for a start */
  bool update (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& u,
               const ProgressCallback& progress);

private:
  std::vector<float> u_; // in voxels of full resolution
};

} // namespace pcl::cosection
