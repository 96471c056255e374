// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "surface/analytic_scene.h"

#include <pcl/cosection/surface/co_section.h>

#include <benchmark/benchmark.h>

// What one more keyframe costs a scene that is followed: an object of about 64^3 voxels, and a background of 256^3.

using namespace pcl::cosection;

namespace
{

constexpr int usual_keyframes = 6;
constexpr int most_keyframes = 40; // that a back end keeps

test::RenderedView
keyframe (const test::AnalyticScene& scene, int n, const Eigen::Vector3d& target, double distance_m)
{
  const double angle = 0.25 * n;
  const Eigen::Vector3d eye = target + distance_m * Eigen::Vector3d (std::cos (angle), std::sin (angle), 0.7);
  return scene.render ({640, 480, 525.0, 525.0, 319.5, 239.5}, test::lookAt (eye, target), 8.0);
}

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
  {
    show (views[n]);
    followed.update (UpdateOutput::Fields);
  }
  SceneResult result;
  for (auto _ : state)
  {
    show (views.back ());
    result = followed.update (UpdateOutput::Fields);
    benchmark::DoNotOptimize (result);
  }
  const SignedDistanceField& field =
      object ? *result.objects.at (0).signed_distance : *result.background_pieces.at (0).signed_distance;
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

/** \brief A room of about 256^3 voxels. */
void
updateBackground (benchmark::State& state)
{
  test::AnalyticScene scene;
  const test::Distance room = test::box ({2.5, 2.5, 2.5});
  const test::Distance table = test::placed (test::box ({0.6, 0.4, 0.03}), Eigen::Vector3d (0.0, 0.0, -1.0));
  scene.add (0, [room, table] (const Eigen::Vector3d& p) { return std::min (-room (p), table (p)); });
  std::vector<test::RenderedView> views;
  for (int n = 0; n < usual_keyframes; ++n)
    views.push_back (keyframe (scene, 4 * n, {0.0, 0.0, -0.9}, 1.5));
  CoSectionOptions options;
  options.whole_background = true;
  options.background_voxel_size_m = 0.02;
  CoSection followed (options);
  update (state, followed, views, false);
}

} // namespace

BENCHMARK (updateObject)->Arg (usual_keyframes)->Arg (most_keyframes)->Unit (benchmark::kMillisecond)->UseRealTime ()->Iterations (3);
BENCHMARK (updateBackground)->Unit (benchmark::kMillisecond)->UseRealTime ()->Iterations (1);
