// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/analytic_scene.h"

#include <pcl/cosection/surface/co_section.h>

#include <benchmark/benchmark.h>

// Three objects on a table in one 640 x 480 view, from oriented points to closed meshes.

using namespace pcl::cosection;

namespace {

test::RenderedView
tableWithThreeObjects ()
{
  test::AnalyticScene scene;
  scene.add (0, test::halfSpace (Eigen::Vector4d::UnitZ ()));
  scene.add (1, test::placed (test::sphere (0.06), Eigen::Vector3d (0.0, 0.0, 0.06)));
  scene.add (2, test::placed (test::box ({0.07, 0.04, 0.05}), Eigen::Vector3d (0.05, 0.16, 0.05)));
  scene.add (3, test::placed (test::cup (0.045, 0.1, 0.006), Eigen::Vector3d (0.0, -0.13, 0.0)));
  return scene.render ({640, 480, 525.0, 525.0, 319.5, 239.5}, lookAt ({0.7, -0.1, 0.5}, {0.0, 0.0, 0.05}));
}

void
scene (benchmark::State& state)
{
  const test::RenderedView seen = tableWithThreeObjects ();
  SceneResult result;
  for (auto _ : state)
  {
    CoSection co_section;
    co_section.addView (seen.view);
    co_section.setBackground (seen.points.at (0));
    for (const auto& [label, points] : seen.points)
      if (label > 0)
        co_section.addObject ({label, points, {}});
    result = co_section.reconstruct ();
  }
  double closed = 0.0;
  for (const ObjectResult& object : result.objects)
    closed += computeTopology (object.mesh).closed_manifold;
  state.counters["closed_meshes"] = closed;
  for (const auto& [stage, seconds] : result.timings_s)
    state.counters[stage + "_s"] = seconds;
}

} // namespace

BENCHMARK (scene)->Unit (benchmark::kSecond)->UseRealTime ();
