// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "common/small_meshes.h"

#include <pcl/cosection/volume/mesh_distance.h>

#include <benchmark/benchmark.h>

// The signed distance of a sphere of 80 % of the grid's edge, on all cores: triangles, and the band in voxels.

using namespace pcl::cosection;

namespace {

void
meshDistance (benchmark::State& state)
{
  constexpr int dim = 100;
  VoxelGrid grid;
  grid.dims.setConstant (dim);
  grid.voxel_size_m = 1.0 / dim;
  grid.origin_m.setConstant (-0.5 + 0.5 * grid.voxel_size_m);
  const TriangleMesh mesh = test::sphereMesh (0.4, static_cast<std::uint32_t> (state.range (0)));
  for (auto _ : state)
    benchmark::DoNotOptimize (
        sampleSignedDistance (mesh, grid, static_cast<double> (state.range (1)) * grid.voxel_size_m).values.data ());
  state.counters["triangles"] = static_cast<double> (mesh.triangles.size ());
}

} // namespace

BENCHMARK (meshDistance)
    ->Args ({16, 5})
    ->Args ({50, 5})
    ->Args ({160, 5})
    ->Args ({160, 20})
    ->UseRealTime ()
    ->Unit (benchmark::kMillisecond);
