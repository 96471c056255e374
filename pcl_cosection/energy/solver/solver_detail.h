// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "row_kernels.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/solver.h>

#include <cmath>
#include <limits>

namespace pcl::cosection {

/** \brief The remaining changes at which a level counts as solved, in units of u. */
struct LevelTolerance
{
  double band;    ///< only voxels with |u| below this count: 1.5 voxels
  double mean;    ///< limit of the root mean square change
  double largest; ///< limit of the change of any voxel

  /** \param[in] scale voxels of the level, in those of the finest, where alone the largest change counts */
  LevelTolerance (const SolverOptions& options, int scale)
      : band (1.5 * scale)
      , mean (options.tolerance_vox * scale)
      , largest (scale == 1 && options.peak_tolerance_vox > 0.0 ? options.peak_tolerance_vox
                                                                : std::numeric_limits<double>::infinity ())
  {}

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
