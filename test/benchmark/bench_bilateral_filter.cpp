// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/fusion/tracking/bilateral_filter.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

// A depth image of 640 x 480 with edges, ripples and holes; "CPU" is the time of all threads together. Argument:
// threads.

using namespace pcl::cosection;

namespace {

void
filter (benchmark::State& state)
{
  Image<float> depth (640, 480);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.at (u, v) = ((u / 37 + v / 53) % 7 == 0
                             ? std::numeric_limits<float>::quiet_NaN ()
                             : 1.0f + 0.5f * ((u / 101) % 2) + 0.02f * std::sin (0.7f * u + 0.9f * v));
  BilateralFilterOptions options;
  options.threads = static_cast<int> (state.range (0));
  for (auto _ : state)
    benchmark::DoNotOptimize (bilateralFilter (depth, options).pixels.data ());
}

} // namespace

BENCHMARK (filter)->Arg (1)->Arg (2)->MeasureProcessCPUTime ()->UseRealTime ()->Unit (benchmark::kMillisecond);
