// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/progress.h>
#include <pcl/cosection/surface/energy_problem.h>
#include <pcl/cosection/surface/options.h>

#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief Why a solver stopped. */
enum class Termination
{
  Converged,     ///< within the tolerance of the solution, as far as the last changes tell
  MaxIterations, ///< the iterations were used up
};

/** \brief What a solver did. */
struct PCL_COSECTION_EXPORT SolverSummary
{
  Termination termination = Termination::MaxIterations;
  int iterations = 0;      ///< on the finest level
  double energy = 0.0;     ///< E (u) at the end, voxel units
  double change_vox = 0.0; ///< root mean square change near the zero set in the last iteration
  double seconds = 0.0;
  std::vector<double> energies; ///< E at the start and after every iteration on the finest level; never rises

  bool converged () const { return termination == Termination::Converged; }
};

/** \brief Minimise \a problem.
 * \param[in,out] u the field in voxels; if its size is not that of the problem, the solver starts
 * coarse to fine, else from the values given, on the finest level only
 * \throws Cancelled if \a progress returns false */
template <typename Real>
PCL_COSECTION_EXPORT SolverSummary solve (const EnergyProblem& problem, const SolverOptions& options,
                                          std::vector<Real>& u, const ProgressCallback& progress = {});

extern template SolverSummary solve<float> (const EnergyProblem&, const SolverOptions&, std::vector<float>&,
                                            const ProgressCallback&);
extern template SolverSummary solve<double> (const EnergyProblem&, const SolverOptions&, std::vector<double>&,
                                             const ProgressCallback&);

} // namespace pcl::cosection
