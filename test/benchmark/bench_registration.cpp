// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tracking/tracking_scene.h"
#include "volume/tsdf_views.h"

#include <pcl/cosection/tracking/sdf_alignment.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

// One frame's pose from 2 degrees and 2 cm away, all pixels used: width of the image, and threads. The background is a
// room's wall and floor with two balls in a volume of 256^3; the object a truck in one of 64^3 that was made from ten
// views, seen from 0.7 m.

using namespace pcl::cosection;

namespace {

PinholeCamera
cameraOf (int width)
{
  return {
      width, width * 3 / 4, width * 525.0 / 640.0, width * 525.0 / 640.0, (width - 1) / 2.0, (width * 3 / 4 - 1) / 2.0};
}

struct Frame
{
  TsdfVolume volume;
  std::vector<Eigen::Vector3f> points;
  Eigen::Isometry3d T_grid_sensor;
  Eigen::Vector3d center;
};

Frame
roomFrame (int width)
{
  const PinholeCamera camera = cameraOf (width);
  const auto walls = test::nearerRay (test::planeRay ({0.1, 0.0, 1.0}, 0.8), test::planeRay ({0.0, 1.0, -0.1}, 0.5));
  const auto balls = test::nearerRay (test::sphereRay (0.3), test::sphereRay (0.15, {0.2, 0.2, -0.1}));
  const Eigen::Isometry3d T_grid_sensor = test::lookAtOrigin ({0.2, -0.1, -2.4});
  const test::BodyView view{T_grid_sensor, test::renderDepth (test::nearerRay (walls, balls), camera, T_grid_sensor)};
  Frame frame{TsdfVolume (test::cubeGrid (256, 2.6 / 256)), view.points (camera), T_grid_sensor,
              Eigen::Vector3d::Zero ()};
  frame.volume.integrate (view.depth, camera, T_grid_sensor);
  return frame;
}

Frame
truckFrame (int width)
{
  const PinholeCamera camera = cameraOf (width);
  const SceneBody truck = test::presetBody ("toys", "truck");
  const Eigen::Vector3d center = test::bodyCenter (truck);
  std::vector<Eigen::Isometry3d> poses;
  for (int n = 0; n < 10; ++n)
    poses.push_back (test::poseOnCircle (center, 0.7, 0.05 * n));
  const auto views = test::renderBody (truck, camera, poses, false);
  TsdfOptions options;
  options.truncation_vox = 5.0;
  return {test::bodyTsdf (truck, camera, views, 64, options), views.back ().points (camera), poses.back (), center};
}

void
align (benchmark::State& state, const Frame& frame)
{
  SdfAlignmentOptions options;
  options.threads = static_cast<int> (state.range (1));
  SdfAlignment alignment (options);
  const Eigen::Isometry3d guess = Eigen::Translation3d (frame.center + Eigen::Vector3d (0.012, -0.012, 0.011)) *
                                  Eigen::AngleAxisd (0.035, Eigen::Vector3d (1.0, 2.0, 3.0).normalized ()) *
                                  Eigen::Translation3d (-frame.center) * frame.T_grid_sensor;
  SdfAlignmentResult result;
  for (auto _ : state)
    result = alignment.align (frame.points, {}, frame.volume, guess);
  state.counters["points"] = static_cast<double> (result.points_with_distance);
  state.counters["iterations"] = result.iterations;
  state.counters["error_mm"] = 1e3 * test::PoseError (result.T_grid_sensor, frame.T_grid_sensor, frame.center).shift_m;
}

void
registerBackground (benchmark::State& state)
{
  static const Frame large = roomFrame (640);
  static const Frame small = roomFrame (320);
  align (state, state.range (0) == 640 ? large : small);
}

void
registerObject (benchmark::State& state)
{
  static const Frame large = truckFrame (640);
  static const Frame small = truckFrame (320);
  align (state, state.range (0) == 640 ? large : small);
}

} // namespace

BENCHMARK (registerBackground)
    ->ArgsProduct ({{640, 320}, {1, 2}})
    ->UseRealTime ()
    ->MeasureProcessCPUTime ()
    ->Unit (benchmark::kMillisecond);
BENCHMARK (registerObject)
    ->ArgsProduct ({{640, 320}, {1, 2}})
    ->UseRealTime ()
    ->MeasureProcessCPUTime ()
    ->Unit (benchmark::kMillisecond);
