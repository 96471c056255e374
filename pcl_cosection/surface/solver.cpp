// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "grid_transfer.h"
#include "solver_detail.h"

#include <chrono>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr int multigrid_coarsest = 8;    // longest axis of the first level
constexpr int fast_jacobi_coarsest = 32; // as in the paper
constexpr int coarse_extra_degree = 1;   // of the smoother: constraints are stiffer on coarse levels
constexpr double coarse_tolerance = 0.1; // tighter: what coarse levels leave undone is slow to mend on finer ones

template <typename Real> SolverSummary
solveLevel (const EnergyProblem& problem, const SolverOptions& options, double scale, bool finest, std::vector<Real>& u,
            const ProgressCallback& progress)
{
  const double band = zero_band_vox * scale;
  const double tolerance = options.tolerance_vox * scale;
  if (options.type == SolverType::FastJacobi)
    return solveLevelFastJacobi (problem, options, band, tolerance, u, progress);
  if (finest)
    return solveLevelMultigrid (problem, options, band, tolerance, u, progress);
  SolverOptions coarse = options;
  coarse.smoothing_degree += coarse_extra_degree;
  return solveLevelMultigrid (problem, coarse, band, coarse_tolerance * tolerance, u, progress);
}

} // namespace

template <typename Real> SolverSummary
solve (const EnergyProblem& problem, const SolverOptions& options, std::vector<Real>& u, const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now ();
  const bool multigrid = options.type == SolverType::Multigrid;
  if (u.size () != problem.size ())
  {
    // Nested iteration: the whole energy on every level, or only data and regulariser (paper).
    std::vector<EnergyProblem> coarse;
    const int coarsest = multigrid ? multigrid_coarsest : fast_jacobi_coarsest;
    for (const EnergyProblem* finer = &problem; finer->dims.maxCoeff () > coarsest; finer = &coarse.back ())
      coarse.push_back (coarsen (*finer, multigrid, options.threads));
    std::vector<Real> values (coarse.empty () ? problem.size () : coarse.back ().size (), Real (0));
    for (std::size_t level = coarse.size (); level-- > 0;)
    {
      const EnergyProblem& at = coarse[level];
      solveLevel (at, options, static_cast<double> (1 << (level + 1)), false, values,
                  [&] (const std::string& stage, double) { return !progress || progress (stage, 0.0); });
      const Eigen::Vector3i& finer = level > 0 ? coarse[level - 1].dims : problem.dims;
      std::vector<Real> up (static_cast<std::size_t> (finer.x ()) * finer.y () * finer.z (), Real (0));
      GridTransfer (finer, 1).prolongAdd (values.data (), up.data (), options.threads);
      values.swap (up);
      coarse.pop_back ();
    }
    u.swap (values);
  }
  SolverSummary summary = solveLevel (problem, options, 1.0, true, u, progress);
  summary.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
  return summary;
}

template SolverSummary
solve<float> (const EnergyProblem&, const SolverOptions&, std::vector<float>&, const ProgressCallback&);
template SolverSummary
solve<double> (const EnergyProblem&, const SolverOptions&, std::vector<double>&, const ProgressCallback&);

} // namespace cosection
} // namespace pcl
