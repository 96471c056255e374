// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "volume/tsdf_views.h"

#include <pcl/cosection/volume/tsdf_volume.h>

#include <benchmark/benchmark.h>

#include <cmath>

// A room's wall and a ball seen at 640 x 480: voxels along each edge of the volume, and threads. The background's
// volume is all in view but its corners; the object's stands around the ball. The plain loop, in one thread, is what
// the definition costs as it is written down.

using namespace pcl::cosection;

namespace {

const PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};

/** \brief One frame, volumes of a given edge about the origin. */
struct View
{
  View ()
      : T_grid_sensor (test::lookAtOrigin ({0.2, -0.1, -2.4}))
      , depth (test::renderDepth (test::nearerRay (test::sphereRay (0.3), test::planeRay ({0.1, 0.0, 1.0}, 0.8)),
                                  camera, T_grid_sensor))
      , weights (camera.width, camera.height, 0.8f)
      , colours (camera.width, camera.height, {200, 120, 40})
  {}

  Eigen::Isometry3d T_grid_sensor;
  Image<float> depth;
  Image<float> weights;
  Picture colours;
};

const View&
view ()
{
  static const View view;
  return view;
}

void
integrate (benchmark::State& state, double edge_m, bool weighted, bool coloured)
{
  const auto dim = static_cast<int> (state.range (0));
  TsdfOptions options;
  options.threads = static_cast<int> (state.range (1));
  options.colour = coloured;
  TsdfVolume volume (test::cubeGrid (dim, edge_m / dim), options);
  TsdfPixels pixels;
  if (weighted)
    pixels.weights = &view ().weights;
  if (coloured)
    pixels.colours = &view ().colours;
  for (auto _ : state)
    volume.integrate (view ().depth, camera, view ().T_grid_sensor, pixels);
  std::size_t seen = 0;
  for (const float w : volume.weights ())
    seen += (w > 0.0f);
  state.counters["voxels"] = static_cast<double> (volume.grid ().size ());
  state.counters["seen"] = static_cast<double> (seen);
}

void
background (benchmark::State& state)
{
  integrate (state, 2.2, false, false);
}

void
backgroundWeighted (benchmark::State& state)
{
  integrate (state, 2.2, true, false);
}

void
backgroundColoured (benchmark::State& state)
{
  integrate (state, 2.2, true, true);
}

void
object (benchmark::State& state)
{
  integrate (state, 1.2, true, true);
}

void
plainLoop (benchmark::State& state)
{
  const auto dim = static_cast<int> (state.range (0));
  const VoxelGrid grid = test::cubeGrid (dim, 2.2 / dim);
  const double truncation = 10.0 * grid.voxel_size_m;
  std::vector<float> values (grid.size (), 0.0f);
  std::vector<float> weights (grid.size (), 0.0f);
  for (auto _ : state)
  {
    const Eigen::Isometry3d T_sensor_grid = view ().T_grid_sensor.inverse ();
    for (int k = 0; k < dim; ++k)
      for (int j = 0; j < dim; ++j)
        for (int i = 0; i < dim; ++i)
        {
          const Eigen::Vector3d p = T_sensor_grid * grid.center (i, j, k);
          if (!(p.z () > 0.0))
            continue;
          const Eigen::Vector2d pixel = camera.project (p);
          const auto u = static_cast<int> (std::floor (pixel.x () + 0.5));
          const auto v = static_cast<int> (std::floor (pixel.y () + 0.5));
          if (u < 0 || v < 0 || u >= camera.width || v >= camera.height)
            continue;
          const double d = (view ().depth.at (u, v) - p.z ()) * p.norm () / p.z ();
          if (!(d >= -truncation))
            continue;
          float& value = values[grid.index (i, j, k)];
          float& weight = weights[grid.index (i, j, k)];
          value = static_cast<float> ((value * weight + std::min (d, truncation)) / (weight + 1.0f));
          weight = std::min (weight + 1.0f, 64.0f);
        }
    benchmark::DoNotOptimize (values.data ());
  }
}

void
surfaceMesh (benchmark::State& state)
{
  const auto dim = static_cast<int> (state.range (0));
  TsdfOptions options;
  options.threads = static_cast<int> (state.range (1));
  TsdfVolume volume (test::cubeGrid (dim, 2.2 / dim), options);
  volume.integrate (view ().depth, camera, view ().T_grid_sensor);
  std::size_t triangles = 0;
  for (auto _ : state)
    triangles = volume.surfaceMesh ().triangles.size ();
  state.counters["triangles"] = static_cast<double> (triangles);
}

void
sample (benchmark::State& state)
{
  TsdfVolume volume (test::cubeGrid (256, 2.2 / 256));
  volume.integrate (view ().depth, camera, view ().T_grid_sensor);
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      points.push_back (view ().T_grid_sensor * camera.unproject (u, v, view ().depth.at (u, v)));
  for (auto _ : state)
  {
    double sum = 0.0;
    for (const auto& p : points)
      if (const auto cell = volume.sample (p))
        sum += cell->value () + cell->gradient ().sum ();
    benchmark::DoNotOptimize (sum);
  }
  state.counters["points"] = static_cast<double> (points.size ());
}

} // namespace

BENCHMARK (background)
    ->Args ({256, 1})
    ->Args ({256, 2})
    ->Args ({512, 2})
    ->UseRealTime ()
    ->Unit (benchmark::kMillisecond);
BENCHMARK (backgroundWeighted)->Args ({256, 2})->UseRealTime ()->Unit (benchmark::kMillisecond);
BENCHMARK (backgroundColoured)->Args ({256, 2})->UseRealTime ()->Unit (benchmark::kMillisecond);
BENCHMARK (object)->Args ({64, 2})->UseRealTime ()->Unit (benchmark::kMillisecond);
BENCHMARK (plainLoop)->Args ({256})->UseRealTime ()->Unit (benchmark::kMillisecond);
BENCHMARK (surfaceMesh)->Args ({256, 2})->UseRealTime ()->Unit (benchmark::kMillisecond);
BENCHMARK (sample)->UseRealTime ()->Unit (benchmark::kMillisecond);
