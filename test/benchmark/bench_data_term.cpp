// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_scene.h"

#include "pcl_cosection/energy/data/imls_data_term.h"

#include <benchmark/benchmark.h>

// Gathering a depth image's points on one core: points per second at sigma = 1 voxel.

using namespace pcl::cosection;

namespace {

void
dataTerm (benchmark::State& state)
{
  const auto scene = benchmark_scenes::makeTableScene (static_cast<int> (state.range (0)));
  const std::vector<OrientedPoint>& points = scene.seen.points.at (1);
  for (auto _ : state)
  {
    state.PauseTiming ();
    ImlsDataTerm data;
    data.add (scene.grid, {}, 1.0, 1); // the arrays: paid per volume, not per point
    state.ResumeTiming ();
    data.add (scene.grid, points, 1.0, 1);
    benchmark::DoNotOptimize (data.weight.data ());
  }
  state.counters["points"] = static_cast<double> (points.size ());
  state.SetItemsProcessed (state.iterations () * static_cast<std::int64_t> (points.size ()));
}

} // namespace

BENCHMARK (dataTerm)->Arg (64)->Arg (128)->Arg (256)->Unit (benchmark::kMillisecond);
