// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "allocation_counter.h"
#include "completion/many_balls.h"
#include "table_scene.h"

#include <pcl/cosection/surface/solver.h>

#include <benchmark/benchmark.h>

#include <algorithm>

// Time and memory of the solver as voxels shrink: the whole energy, from nothing. The memory is that of
// the problem, its solution, and what the solver needs besides. And time as objects of few points become many.

using namespace pcl::cosection;

namespace {

void
scaling (benchmark::State& state)
{
  const auto resolution = static_cast<int> (state.range (0));
  const std::size_t before = AllocationCounter::current ();
  const EnergyProblem problem = benchmark_scenes::makeEnergyProblem (benchmark_scenes::makeTableScene (resolution));
  std::size_t peak = 0;
  SolverSummary summary;
  for (auto _ : state)
  {
    AllocationCounter::restart ();
    std::vector<float> u;
    summary = solve (problem, SolverOptions (), u);
    peak = std::max (peak, AllocationCounter::peak () - before);
  }
  state.counters["bytes_per_voxel"] = static_cast<double> (peak) / static_cast<double> (problem.size ());
  state.counters["iterations"] = summary.iterations;
  state.counters["converged"] = summary.converged ();
}

void
manyObjects (benchmark::State& state)
{
  const auto count = static_cast<int> (state.range (0));
  for (auto _ : state)
    benchmark::DoNotOptimize (test::completeManyBalls (count, 0));
  state.counters["per_object_s"] = benchmark::Counter (count, benchmark::Counter::kIsIterationInvariantRate |
                                                                  benchmark::Counter::kInvert);
}

} // namespace

BENCHMARK (scaling)->Arg (64)->Arg (128)->Arg (256)->Unit (benchmark::kSecond)->UseRealTime ();
BENCHMARK (manyObjects)->Arg (50)->Arg (100)->Arg (250)->Arg (500)->Unit (benchmark::kSecond)->UseRealTime ();
