// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/solver.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

constexpr int fixed_layers = 2; ///< of voxels at the border of a part of a grid: the radius of the Hessian's stencil

/** \brief Fix a field at its values at the border of a part of a larger grid, as a boundary condition of Dirichlet's
 * kind: by strong data terms, without bounds.
 * \param[in] free the voxels that are not fixed; both ends belong to it
 * \param[in] u one value per voxel of \a part, voxels */
void holdBorder (const Eigen::AlignedBox3i& free, const std::vector<float>& u, EnergyProblem& part);

/** \brief The voxels at which a field is to minimise an energy: those no farther from data than reach_vox. */
struct NearData
{
  const std::vector<float>& distance_vox; ///< one per voxel
  float reach_vox;
};

/** \brief Result of a local solve. */
struct LocalSolution
{
  SolverSummary summary;  ///< iterations: the maximum over all boxes; without intermediate energies
  std::size_t voxels = 0; ///< number of voxels that were solved
};

/** \brief Minimise a problem near data, in the parts of the grid where the given field is not yet the minimiser.
 *
 * The grid is divided into bricks. Those with a voxel near data that a step of Jacobi's method would change by more
 * than a tolerance are united to boxes. Each box is solved with a margin, beyond which the field is held fixed; all
 * boxes start from the same field (restricted additive Schwarz method: X.-C. Cai and M. Sarkis, SIAM Journal on
 * Scientific Computing 1999). Where boxes then disagree, or a margin was too small, they are solved once more. Far from
 * data the field must be right already, as a start from coarser voxels is.
 *
 * \param[in,out] u one value per voxel, voxels
 * \return nothing, and nothing is done, if the boxes are so large that solve () takes no longer
 * \throws Cancelled if \a progress returns false */
std::optional<LocalSolution> solveNearData (const EnergyProblem& problem, const SolverOptions& options,
                                            const NearData& near, std::vector<float>& u,
                                            const ProgressCallback& progress);

/** \brief A coarse minimiser, on voxels of four times the size, beside one at full resolution while the problem
 * changes. The change of the coarse minimiser is added to the fine one, which keeps its detail. Errors do not
 * accumulate over many changes, as the differences add up to one difference. */
class QuarterResolution
{
public:
  /** \param[in,out] u the minimiser before the change; then an approximation of the one after it, except for detail. If
   * its size is wrong, it becomes a start for solve ()
   * \return whether a change was followed; false the first time, and always if the solver has no such level
   * \throws Cancelled; \a u is then unchanged, or a start */
  bool update (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& u,
               const ProgressCallback& progress);

private:
  std::vector<float> u_; // in voxels of full resolution
};

} // namespace pcl::cosection
