// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_scene.h"

#include <pcl/cosection/surface/solver.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

// The whole energy on 64^3 voxels, from nothing: multigrid, and how far Fast Jacobi gets in a hundred
// times as long.

using namespace pcl::cosection;

namespace {

constexpr int resolution = 64;
constexpr double near_vox = 1.5;     // where the error is measured: |u| below that
constexpr double reached_vox = 0.05; // root mean square error at which Fast Jacobi counts as done
constexpr double time_ratio = 100.0; // of Fast Jacobi to multigrid
constexpr int cycles_per_look = 10;  // of Fast Jacobi, between looks at its error

const EnergyProblem&
problem ()
{
  static const EnergyProblem value = benchmark_scenes::makeEnergyProblem (
      benchmark_scenes::makeTableScene (resolution));
  return value;
}

/** \brief The minimiser, far more accurate than any solver is asked for. */
const std::vector<double>&
minimiser ()
{
  static const std::vector<double> value = [] {
    SolverOptions options;
    options.tolerance_vox = 1e-7;
    options.max_iterations = 1000;
    std::vector<double> u;
    solve (problem (), options, u);
    return u;
  }();
  return value;
}

double
rmsError (const std::vector<float>& u)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < u.size (); ++n)
    if (std::abs (minimiser ()[n]) < near_vox)
    {
      sum += std::pow (u[n] - minimiser ()[n], 2);
      ++count;
    }
  return std::sqrt (sum / static_cast<double> (count));
}

void
multigrid (benchmark::State& state)
{
  problem ();
  std::vector<float> u;
  SolverSummary summary;
  for (auto _ : state)
  {
    u.clear ();
    summary = solve (problem (), SolverOptions (), u);
  }
  state.counters["multigrid_s"] = summary.seconds;
  state.counters["iterations"] = summary.iterations;
  state.counters["converged"] = summary.converged ();
  state.counters["multigrid_rms_vox"] = rmsError (u);
}

void
fastJacobiInAHundredTimesTheTime (benchmark::State& state)
{
  std::vector<float> u;
  for (auto _ : state)
  {
    double multigrid_s = std::numeric_limits<double>::infinity ();
    for (int i = 0; i < 3; ++i)
    {
      u.clear ();
      multigrid_s = std::min (multigrid_s, solve (problem (), SolverOptions (), u).seconds);
    }

    // Its cycles know nothing of each other, so stopping to look and going on changes nothing.
    SolverOptions options;
    options.type = SolverType::FastJacobi;
    options.tolerance_vox = 0.0;
    u.clear ();
    SolverSummary summary = solve (problem (), options, u);
    double seconds = summary.seconds;
    int cycles = summary.iterations;
    double reached_s = 0.0;
    options.max_iterations = cycles_per_look;
    while (true)
    {
      if (reached_s == 0.0 && rmsError (u) < reached_vox)
        reached_s = seconds;
      if (seconds >= time_ratio * multigrid_s)
        break;
      summary = solve (problem (), options, u);
      seconds += summary.seconds;
      cycles += summary.iterations;
    }
    state.counters["multigrid_s"] = multigrid_s;
    state.counters["fast_jacobi_s"] = seconds;
    state.counters["fast_jacobi_cycles"] = cycles;
    state.counters["fast_jacobi_rms_vox"] = rmsError (u);
    state.counters["fast_jacobi_reached_s"] = reached_s; // 0: not within the time
  }
}

} // namespace

BENCHMARK (multigrid)->Unit (benchmark::kSecond)->UseRealTime ();
BENCHMARK (fastJacobiInAHundredTimesTheTime)->Unit (benchmark::kSecond)->UseRealTime ()->Iterations (1);
