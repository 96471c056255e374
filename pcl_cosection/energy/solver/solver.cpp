// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid_transfer.h"
#include "local_solver.h"
#include "solver_detail.h"

#include <chrono>

namespace pcl::cosection {
namespace {

constexpr int multigrid_coarsest = 8;    // longest axis of the first level
constexpr int fast_jacobi_coarsest = 32; // as in the paper
constexpr int coarse_extra_degree = 1;   // of the smoother: constraints are stiffer on coarse levels
constexpr double coarse_tolerance = 0.1; // factor: errors that coarse levels leave are slow to remove on finer ones

/** \param[in] scale voxels of the level, in those of the finest */
template <typename Real>
SolverSummary
solveLevel (const EnergyProblem& problem, const SolverOptions& options, int scale, std::vector<Real>& u,
            const ProgressCallback& progress)
{
  LevelTolerance tolerance (options, scale);
  if (options.type == SolverType::FastJacobi)
    return solveLevelFastJacobi (problem, options, tolerance, u, progress);
  if (scale == 1)
    return solveLevelMultigrid (problem, options, tolerance, u, progress);
  SolverOptions coarse = options;
  coarse.smoothing_degree += coarse_extra_degree;
  tolerance.mean *= coarse_tolerance;
  return solveLevelMultigrid (problem, coarse, tolerance, u, progress);
}

template <typename Real>
std::vector<Real>
interpolate (const std::vector<Real>& coarse, const Eigen::Vector3i& dims, int threads)
{
  std::vector<Real> u (static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (), Real (0));
  GridTransfer (dims, 1).prolongAdd (coarse.data (), u.data (), threads);
  return u;
}

bool
hasCoarserLevel (const EnergyProblem& problem, const SolverOptions& options)
{
  return problem.dims.maxCoeff () > (options.type == SolverType::Multigrid ? multigrid_coarsest : fast_jacobi_coarsest);
}

/** \brief The next coarser problem: the whole energy, or only data and regulariser for Fast Jacobi (paper). */
EnergyProblem
coarserProblem (const EnergyProblem& problem, const SolverOptions& options)
{
  return coarsen (problem, options.type == SolverType::Multigrid, options.threads);
}

/** \brief Nested iteration: solve the problem; if \a u is no start, the solution of the next coarser problem is one. */
template <typename Real>
SolverSummary
solveNested (const EnergyProblem& problem, const SolverOptions& options, int scale, std::vector<Real>& u,
             const ProgressCallback& progress)
{
  if (u.size () != problem.size ())
  {
    u.clear ();
    if (hasCoarserLevel (problem, options))
      solveNested (coarserProblem (problem, options), options, 2 * scale, u,
                   [&] (const std::string& stage, double) { return !progress || progress (stage, 0.0); });
    u = u.empty () ? std::vector<Real> (problem.size (), Real (0)) : interpolate (u, problem.dims, options.threads);
  }
  return solveLevel (problem, options, scale, u, progress);
}

} // namespace

template <typename Real>
SolverSummary
solve (const EnergyProblem& problem, const SolverOptions& options, std::vector<Real>& u,
       const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now ();
  SolverSummary summary = solveNested (problem, options, 1, u, progress);
  summary.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
  return summary;
}

bool
solveAtHalfResolution (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& half,
                       std::vector<float>& u, const ProgressCallback& progress)
{
  if (options.type != SolverType::Multigrid || !hasCoarserLevel (problem, options))
    return false;
  solveNested (coarserProblem (problem, options), options, 2, half, progress);
  u = interpolate (half, problem.dims, options.threads);
  return true;
}

bool
QuarterResolution::update (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& u,
                           const ProgressCallback& progress)
{
  if (options.type != SolverType::Multigrid || !hasCoarserLevel (problem, options))
    return false;
  const EnergyProblem half = coarserProblem (problem, options);
  if (!hasCoarserLevel (half, options))
    return false;
  const EnergyProblem quarter = coarserProblem (half, options);
  std::vector<float> next (u_);
  solveNested (quarter, options, 4, next, progress);
  const bool follows = next.size () == u_.size () && u.size () == problem.size ();
  std::vector<float> on_half;
  if (follows)
  {
    for (std::size_t n = 0; n < next.size (); ++n)
      u_[n] = next[n] - u_[n];
    on_half = interpolate (u_, half.dims, options.threads);
  }
  u_ = std::move (next);
  if (follows)
    GridTransfer (problem.dims, 1).prolongAdd (on_half.data (), u.data (), options.threads);
  if (u.size () == problem.size ())
    return follows;
  on_half = interpolate (u_, half.dims, options.threads);
  solveNested (half, options, 2, on_half, progress);
  u = interpolate (on_half, problem.dims, options.threads);
  return false;
}

template SolverSummary solve<float> (const EnergyProblem&, const SolverOptions&, std::vector<float>&,
                                     const ProgressCallback&);
template SolverSummary solve<double> (const EnergyProblem&, const SolverOptions&, std::vector<double>&,
                                      const ProgressCallback&);

} // namespace pcl::cosection
