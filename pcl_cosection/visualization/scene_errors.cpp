// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/evaluation/surface_distance.h"
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double usual_share = 0.95; ///< of the errors that the colours distinguish

std::vector<double>
errorsOf (const TriangleMesh& mesh, const SurfaceDistance& truth, const Eigen::Isometry3d& T_truth_mesh, int threads)
{
  if (mesh.empty ())
    return {};
  return vertexDistances (transformMesh (mesh, T_truth_mesh), truth, threads);
}

} // namespace

void
measureErrors (RunScene& scene, const SceneRecord& truth, const RunEvaluation& evaluation, int threads)
{
  scene.errors.clear ();
  std::vector<double> all;
  for (const ObjectEvaluation& object : evaluation.objects)
  {
    const auto of_truth = std::find_if (truth.objects.begin (), truth.objects.end (),
                                        [&object] (const SceneRecord::Object& o) { return o.id == object.truth_id; });
    if (of_truth == truth.objects.end () || of_truth->mesh.empty ())
      continue;
    const SurfaceDistance surface (of_truth->mesh);
    const Eigen::Isometry3d& T_truth_estimate = object.mesh.alignment.T_truth_estimate;
    VertexErrors& errors = scene.errors[object.id];
    errors.completed = errorsOf (scene.surface (object.id, SurfaceMode::Completed), surface, T_truth_estimate, threads);
    errors.tsdf = errorsOf (scene.surface (object.id, SurfaceMode::Tsdf), surface, T_truth_estimate, threads);
    all.insert (all.end (), errors.completed.begin (), errors.completed.end ());
  }
  if (evaluation.background && !truth.background.empty ())
    scene.errors[RunScene::background].completed = errorsOf (scene.run.background, SurfaceDistance (truth.background),
                                                             evaluation.background->alignment.T_truth_estimate,
                                                             threads);
  if (all.empty () && scene.errors.count (RunScene::background) > 0)
    all = scene.errors[RunScene::background].completed;
  if (all.empty ())
    return;
  scene.error_max_m = roundErrorUp (quantile (all, usual_share));
}

std::vector<std::string>
measureErrors (RunScene& scene, const SceneRecord& truth, int threads)
{
  RunOptions options;
  options.comparison.samples = 100; // only the alignment is asked for
  options.measure_penetration = false;
  options.threads = threads;
  const RunEvaluation evaluation = evaluateRun (truth, scene.run, options);
  measureErrors (scene, truth, evaluation, threads);
  return evaluation.warnings;
}

} // namespace pcl::cosection
