// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/analytic_scene.h"

#include <pcl/cosection/surface/co_section.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>

// What one more keyframe costs a scene that is followed: an object of about 64^3 voxels, and a background of 256^3.

using namespace pcl::cosection;

namespace {

constexpr int usual_keyframes = 6;
constexpr int most_keyframes = 40; // that a back end keeps

test::RenderedView
keyframe (const test::AnalyticScene& scene, int n, const Eigen::Vector3d& target, double distance_m)
{
  const double angle = 0.25 * n;
  const Eigen::Vector3d eye = target + distance_m * Eigen::Vector3d (std::cos (angle), std::sin (angle), 0.7);
  return scene.render ({640, 480, 525.0, 525.0, 319.5, 239.5}, lookAt (eye, target), 8.0);
}

/** \brief With the noise of a sensor along every ray. */
void
addNoise (test::RenderedView& seen, unsigned seed)
{
  std::mt19937 random (seed);
  std::normal_distribution<double> unit;
  for (float& depth : seen.view.depth)
    if (std::isfinite (depth))
      depth += static_cast<float> (depthNoiseSigma (depth) * unit (random));
  for (auto& [label, points] : seen.points)
    for (OrientedPoint& p : points)
    {
      const Eigen::Vector3d in_sensor = seen.view.T_world_sensor.inverse () * p.position.cast<double> ();
      const double scale = 1.0 + depthNoiseSigma (in_sensor.z ()) * unit (random) / in_sensor.z ();
      p.position = (seen.view.T_world_sensor * (scale * in_sensor)).cast<float> ();
    }
}

/** \brief The last view is the one more. */
void
update (benchmark::State& state, CoSection& followed, const std::vector<test::RenderedView>& views, bool object)
{
  const auto show = [&] (const test::RenderedView& seen) {
    followed.addView (seen.view);
    if (object)
      followed.addPoints (1, seen.points.at (1));
    else
      followed.addBackground (seen.points.at (0));
  };
  for (std::size_t n = 0; n + 1 < views.size (); ++n)
    show (views[n]);
  followed.update (UpdateOutput::Fields);
  SceneResult result;
  for (auto _ : state)
  {
    show (views.back ());
    result = followed.update (UpdateOutput::Fields);
    benchmark::DoNotOptimize (result);
  }
  const SignedDistanceField& field = object ? *result.objects.at (0).signed_distance
                                            : *result.background_pieces.at (0).signed_distance;
  state.counters["voxels"] = static_cast<double> (field.grid.size ());
  for (const auto& [stage, seconds] : result.timings_s)
    state.counters[stage + "_s"] = seconds;
}

/** \brief An object on a table, one keyframe more than so many; the table as a plane. */
void
updateObject (benchmark::State& state)
{
  test::AnalyticScene scene;
  scene.add (0, test::halfSpace (Eigen::Vector4d::UnitZ ()));
  scene.add (1, test::placed (test::box ({0.1, 0.06, 0.08}), Eigen::Vector3d (0.0, 0.0, 0.08)));
  std::vector<test::RenderedView> views;
  for (int n = 0; n < state.range (0); ++n)
    views.push_back (keyframe (scene, n, {0.0, 0.0, 0.06}, 0.9));
  CoSectionOptions options;
  options.voxel_size_m = 0.2 / 48;
  CoSection followed (options);
  followed.addSupportPlane (Eigen::Vector4d::UnitZ ());
  update (state, followed, views, true);
}

/** \brief A room of 256^3 voxels, seen all around but for one gap; the last view looks into that, or at what others
 * have seen. */
void
updateBackground (benchmark::State& state)
{
  test::AnalyticScene scene;
  const test::Distance room = test::box ({2.39, 2.39, 2.39});
  const test::Distance table = test::placed (test::box ({0.6, 0.4, 0.03}), Eigen::Vector3d (1.2, 0.0, -1.7));
  const test::Distance cupboard = test::placed (test::box ({0.4, 0.8, 0.9}), Eigen::Vector3d (-2.0, 0.5, -1.57));
  scene.add (0, [=] (const Eigen::Vector3d& p) { return std::min ({-room (p), table (p), cupboard (p)}); });
  const PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  std::vector<test::RenderedView> views;
  const auto look = [&] (const Eigen::Vector3d& eye, double azimuth, double elevation) {
    const Eigen::Vector3d ray (std::cos (azimuth) * std::cos (elevation), std::sin (azimuth) * std::cos (elevation),
                               std::sin (elevation));
    views.push_back (scene.render (camera, lookAt (eye, eye + ray), 8.0));
    addNoise (views.back (), static_cast<unsigned> (views.size ()));
  };
  constexpr int directions = 9;
  for (const double elevation : {-0.5, 0.4})
    for (int n = 1; n < directions; ++n)
      look ({0.1, -0.2, 0.1}, 2.0 * M_PI * n / directions, elevation);
  const bool into_gap = state.range (0) != 0;
  look ({-0.2, 0.3, 0.0}, into_gap ? 0.0 : 2.0 * M_PI * 4.3 / directions, -0.4);
  CoSectionOptions options;
  options.whole_background = true;
  options.background_voxel_size_m = 0.02;
  CoSection followed (options);
  update (state, followed, views, false);
}

} // namespace

BENCHMARK (updateObject)
    ->Arg (usual_keyframes)
    ->Arg (most_keyframes)
    ->Unit (benchmark::kMillisecond)
    ->UseRealTime ()
    ->MeasureProcessCPUTime ()
    ->Iterations (3);
BENCHMARK (updateBackground)
    ->ArgName ("gap")
    ->Arg (0)
    ->Arg (1)
    ->Unit (benchmark::kMillisecond)
    ->UseRealTime ()
    ->MeasureProcessCPUTime ()
    ->Iterations (1);
