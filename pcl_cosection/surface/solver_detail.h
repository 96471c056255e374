// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/solver.h>

namespace pcl
{
namespace cosection
{

/** \brief Values within this many voxels of zero count as near the zero set. */
constexpr double zero_band_vox = 1.5;

/** \brief One level of a solve: minimise from the given u. \a tolerance_vox in units of u. */
template <typename Real> SolverSummary
solveLevelMultigrid (const EnergyProblem& problem, const SolverOptions& options, double band, double tolerance,
                     std::vector<Real>& u, const ProgressCallback& progress);

template <typename Real> SolverSummary
solveLevelFastJacobi (const EnergyProblem& problem, const SolverOptions& options, double band, double tolerance,
                      std::vector<Real>& u, const ProgressCallback& progress);

/** \brief Minimise on voxels of twice the size, as all constraints allow but Fast Jacobi does not.
 * \param[in,out] half the field there, voxels of \a problem; if its size is wrong, started coarse to fine
 * \param[out] u \a half interpolated: a start for solve ()
 * \return false, and nothing is done, if the solver has no such level */
bool
solveAtHalfResolution (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& half,
                       std::vector<float>& u, const ProgressCallback& progress);

inline void
report (const ProgressCallback& progress, double fraction)
{
  if (progress && !progress ("solve", fraction))
    throw Cancelled ("cancelled");
}

} // namespace cosection
} // namespace pcl
