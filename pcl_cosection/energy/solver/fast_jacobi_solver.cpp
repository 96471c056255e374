// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "energy.h"
#include "hessian_rows.h"
#include "solver_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double energy_rounding = 1e-6;   // relative
constexpr double largest_eigenvalue = 3.5; // of D^-1 times half the Hessian of E, over any active set

/** \brief Relaxation factors of a cycle, omega / (2 cos^2 (pi (2 i + 1) / (4 n + 2))), reordered so that
 * large and small ones compensate early (Leja ordering of their reciprocals). */
std::vector<double>
relaxationFactors (int cycle_length)
{
  const double omega = 2.0 / largest_eigenvalue;
  std::vector<double> factors;
  for (int i = 0; i < cycle_length; ++i)
  {
    const double c = std::cos (M_PI * (2.0 * i + 1.0) / (4.0 * cycle_length + 2.0));
    factors.push_back (omega / (2.0 * c * c));
  }
  for (int n = 0; n < cycle_length; ++n)
  {
    int best = n;
    double best_distance = -std::numeric_limits<double>::infinity ();
    for (int candidate = n; candidate < cycle_length; ++candidate)
    {
      double distance = n == 0 ? 1.0 / factors[candidate] : 0.0;
      for (int chosen = 0; chosen < n; ++chosen)
        distance += std::log (std::abs (1.0 / factors[candidate] - 1.0 / factors[chosen]));
      if (distance > best_distance)
      {
        best_distance = distance;
        best = candidate;
      }
    }
    std::swap (factors[n], factors[best]);
  }
  return factors;
}

} // namespace

template <typename Real>
SolverSummary
solveLevelFastJacobi (const EnergyProblem& problem, const SolverOptions& options, const LevelTolerance& tolerance,
                      std::vector<Real>& u, const ProgressCallback& progress)
{
  SolverSummary summary;
  const HessianOperator<Real> hessian (problem.dims, options.threads);
  const std::vector<Real> diagonal = hessian.diagonal ();
  std::vector<Real> residual (u.size ());
  std::vector<std::uint16_t> weights (u.size ());
  std::vector<Real> before (u.size ());
  int cycle_length = options.cycle_length;
  std::vector<double> factors = relaxationFactors (cycle_length);
  const std::size_t plane = static_cast<std::size_t> (problem.dims.x ()) * problem.dims.y ();

  summary.energies.push_back (evaluate (problem, hessian, u.data (), residual.data (), weights.data ()));
  for (int cycle = 0; cycle < options.max_iterations; ++cycle)
  {
    report (progress, static_cast<double> (cycle) / options.max_iterations);
    before = u;
    double energy = summary.energies.back ();
    for (const double factor : factors)
    {
      parallelFor (0, problem.dims.z (), options.threads, [&] (int k) {
        for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
          u[n] += static_cast<Real> (factor) * residual[n] /
                  (static_cast<Real> (problem.alpha) * diagonal[n] +
                   static_cast<Real> (kernels::unpackWeight (weights[n])));
      });
      energy = evaluate (problem, hessian, u.data (), residual.data (), weights.data ());
    }
    const double previous = summary.energies.back ();
    if (!(energy <= previous + energy_rounding * std::abs (previous)) && cycle_length > 1)
    {
      // Long cycles amplify rounding errors, and the active set changes within them: undo it, and shorten the cycles.
      u = before;
      cycle_length /= 2;
      factors = relaxationFactors (cycle_length);
      summary.energies.push_back (evaluate (problem, hessian, u.data (), residual.data (), weights.data ()));
      ++summary.iterations;
      continue;
    }
    kernels::SquaredChange change;
    for (std::size_t n = 0; n < u.size (); ++n)
      if (std::min (std::abs (before[n]), std::abs (u[n])) < static_cast<Real> (tolerance.band))
      {
        const double squared = std::pow (static_cast<double> (u[n] - before[n]), 2);
        change += {squared, 1.0, squared};
      }
    summary.change_vox = change.rootMean ();
    summary.energies.push_back (energy);
    ++summary.iterations;
    if (tolerance.met (change))
    {
      summary.termination = Termination::Converged;
      break;
    }
  }
  summary.energy = summary.energies.back ();
  return summary;
}

template SolverSummary solveLevelFastJacobi<float> (const EnergyProblem&, const SolverOptions&, const LevelTolerance&,
                                                    std::vector<float>&, const ProgressCallback&);
template SolverSummary solveLevelFastJacobi<double> (const EnergyProblem&, const SolverOptions&, const LevelTolerance&,
                                                     std::vector<double>&, const ProgressCallback&);

} // namespace pcl::cosection
