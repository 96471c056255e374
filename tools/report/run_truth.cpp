// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_truth.h"

#include "pcl_cosection/evaluation/surface_distance.h"
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

const SceneRecord::Object*
trueObject (const SceneRecord& truth, int id)
{
  const auto found = std::find_if (truth.objects.begin (), truth.objects.end (),
                                   [id] (const auto& object) { return (object.id == id); });
  return (found == truth.objects.end () || found->mesh.empty () ? nullptr : &*found);
}

} // namespace

const ObjectEvaluation*
evaluationOf (const RunEvaluation& run, int id)
{
  const auto found = std::find_if (run.objects.begin (), run.objects.end (),
                                   [id] (const auto& object) { return (object.id == id); });
  return (found == run.objects.end () ? nullptr : &*found);
}

RunTruth
compareWithTruth (const RunScene& run, const std::string& dataset, int threads)
{
  RunTruth result;
  ReadingNotes notes;
  result.truth = readTruth (dataset, notes);
  result.notes = notes.warnings;
  RunOptions options;
  options.threads = threads;
  options.comparison.threads = threads;
  result.evaluation = evaluateRun (result.truth, run.run, options);
  for (const ObjectEvaluation& object : result.evaluation.objects)
  {
    const SceneRecord::Object* true_object = trueObject (result.truth, object.truth_id);
    const TriangleMesh& seen = run.surface (object.id, SurfaceMode::Tsdf);
    if (true_object != nullptr && !seen.empty ())
      result.seen[object.id] = compareMeshes (
          true_object->mesh, transformMesh (seen, object.mesh.alignment.T_truth_estimate), options.comparison);
  }
  return (result);
}

std::vector<double>
errorsOf (const RunTruth& truth, int id, const TriangleMesh& mesh, int threads)
{
  const ObjectEvaluation* evaluation = evaluationOf (truth.evaluation, id);
  const SceneRecord::Object* true_object = evaluation == nullptr ? nullptr
                                                                 : trueObject (truth.truth, evaluation->truth_id);
  if (true_object == nullptr)
    return {};
  return (vertexDistances (transformMesh (mesh, evaluation->mesh.alignment.T_truth_estimate),
                           SurfaceDistance (true_object->mesh), threads));
}
