// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "volume/tsdf_views.h"

#include <pcl/cosection/volume/tsdf_raycast.h>

#include <benchmark/benchmark.h>

// A corner of a room and a ball in it, averaged from five views within the room and seen at 640 x 480 from between
// them; "CPU" is the time of all threads together. Arguments: voxels along each edge of the volume, stride, and
// threads.

using namespace pcl::cosection;

namespace {

const PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};

/** \brief From corner to corner of a room. */
Eigen::Isometry3d
eyePose (double shift)
{
  return test::lookAtOrigin (Eigen::Vector3d (-1.1 + shift, -0.5 - shift, -1.1 + 0.5 * shift));
}

TsdfVolume
seenVolume (int dim, double edge_m)
{
  TsdfVolume volume (test::cubeGrid (dim, edge_m / dim));
  const auto walls = test::nearerRay (test::planeRay (Eigen::Vector3d::UnitX (), 1.3),
                                      test::nearerRay (test::planeRay (Eigen::Vector3d::UnitY (), 0.7),
                                                       test::planeRay (Eigen::Vector3d::UnitZ (), 1.3)));
  const auto scene = test::nearerRay (test::nearerRay (test::sphereRay (0.3), walls),
                                      test::planeRay (Eigen::Vector3d::UnitY (), -1.3));
  for (int n = -2; n <= 2; ++n)
  {
    const auto pose = eyePose (0.1 * n);
    volume.integrate (test::renderDepth (scene, camera, pose), camera, pose);
  }
  return volume;
}

void
cast (benchmark::State& state, const std::vector<RaycastBody>& bodies, bool normals)
{
  RaycastOptions options;
  options.stride = static_cast<int> (state.range (1));
  options.threads = static_cast<int> (state.range (2));
  options.normals = normals;
  std::size_t hits = 0;
  for (auto _ : state)
  {
    hits = 0;
    for (const float z : raycast (bodies, camera, options).depth.pixels)
      hits += (z > 0.0f);
  }
  state.counters["hits"] = static_cast<double> (hits);
}

const Eigen::Isometry3d eye = eyePose (0.05);

void
background (benchmark::State& state)
{
  const TsdfVolume volume = seenVolume (static_cast<int> (state.range (0)), 3.0);
  cast (state, {{&volume, eye}}, false);
}

void
backgroundWithNormals (benchmark::State& state)
{
  const TsdfVolume volume = seenVolume (static_cast<int> (state.range (0)), 3.0);
  cast (state, {{&volume, eye}}, true);
}

void
object (benchmark::State& state)
{
  const TsdfVolume volume = seenVolume (static_cast<int> (state.range (0)), 0.9);
  cast (state, {{&volume, eye, 1}}, false);
}

/** \brief A room, and three objects side by side in it. */
void
scene (benchmark::State& state)
{
  const TsdfVolume room = seenVolume (static_cast<int> (state.range (0)), 3.0);
  const TsdfVolume ball = seenVolume (64, 0.9);
  std::vector<RaycastBody> bodies{{&room, eye}};
  for (int n = 0; n < 3; ++n)
  {
    Eigen::Isometry3d pose = eye;
    pose.translation () += Eigen::Vector3d (0.4 * (n - 1), 0.1, 0.4 * (1 - n));
    bodies.push_back ({&ball, pose, static_cast<std::uint16_t> (n + 1)});
  }
  cast (state, bodies, false);
}

} // namespace

#define PCL_COSECTION_TIMES MeasureProcessCPUTime ()->UseRealTime ()->Unit (benchmark::kMillisecond)
BENCHMARK (background)->Args ({256, 1, 1})->Args ({256, 1, 2})->Args ({256, 2, 1})->PCL_COSECTION_TIMES;
BENCHMARK (backgroundWithNormals)->Args ({256, 1, 1})->PCL_COSECTION_TIMES;
BENCHMARK (object)->Args ({64, 1, 1})->PCL_COSECTION_TIMES;
BENCHMARK (scene)->Args ({256, 1, 1})->PCL_COSECTION_TIMES;
