// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "row_kernels.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/solver.h>

#include <cmath>

namespace pcl::cosection {

/** \brief Values within this many voxels of zero count as near the zero set. */
constexpr double zero_band_vox = 1.5;

/** \brief The remaining changes at which a level counts as solved, in units of u. */
struct LevelTolerance
{
  double band;    ///< only voxels with |u| below this count
  double mean;    ///< limit of the root mean square change
  double largest; ///< limit of the change of any voxel

  /** \brief Whether \a factor times the last change is below both limits. */
  bool met (const kernels::SquaredChange& change, double factor = 1.0) const
  {
    return factor * change.rootMean () < mean && factor * std::sqrt (change.largest) < largest;
  }
};

/** \brief Minimise the energy of one level from the given u, by multigrid. */
template <typename Real>
SolverSummary solveLevelMultigrid (const EnergyProblem& problem, const SolverOptions& options,
                                   const LevelTolerance& tolerance, std::vector<Real>& u,
                                   const ProgressCallback& progress);

template <typename Real>
SolverSummary solveLevelFastJacobi (const EnergyProblem& problem, const SolverOptions& options,
                                    const LevelTolerance& tolerance, std::vector<Real>& u,
                                    const ProgressCallback& progress);

/** \brief Minimise on voxels of twice the size. Fast Jacobi has no such level.
 * \param[in,out] half the field there, voxels of \a problem; if its size is wrong, started coarse to fine
 * \param[out] u \a half interpolated: a start for solve ()
 * \return false, and nothing is done, if the solver has no such level */
bool solveAtHalfResolution (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& half,
                            std::vector<float>& u, const ProgressCallback& progress);

inline void
report (const ProgressCallback& progress, double fraction)
{
  if (progress && !progress ("solve", fraction))
    throw Cancelled ("cancelled");
}

} // namespace pcl::cosection
