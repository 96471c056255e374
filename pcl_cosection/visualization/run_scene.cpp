// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/run_scene.h>

#include "completed_scene.h"
#include "scene_summary.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/json_depth.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

constexpr double usual_share = 0.95; ///< of the errors that the colours distinguish

bool
isThere (const fs::path& path)
{
  std::error_code ignored;
  return fs::exists (path, ignored);
}

std::optional<Eigen::Isometry3d>
nearestPose (const std::vector<StampedPose>& poses, double stamp, double limit)
{
  const auto after = std::lower_bound (poses.begin (), poses.end (), stamp,
                                       [] (const StampedPose& pose, double wanted) { return pose.stamp < wanted; });
  const StampedPose* nearest = nullptr;
  for (const auto& candidate : {after, after == poses.begin () ? poses.end () : after - 1})
    if (candidate != poses.end () &&
        (!nearest || std::abs (candidate->stamp - stamp) < std::abs (nearest->stamp - stamp)))
      nearest = &*candidate;
  if (!nearest || !(std::abs (nearest->stamp - stamp) < limit))
    return std::nullopt;
  return nearest->pose;
}

/** \brief What is in summary.json, which may lack anything, as those of earlier versions do; nothing if there is no
 * such file. */
std::optional<Json>
readSummary (const std::string& folder, ReadingNotes& notes)
{
  const std::string path = (fs::path (folder) / "summary.json").string ();
  std::error_code none;
  if (!fs::exists (path, none))
    return std::nullopt;
  Json json;
  try
  {
    const std::string text = readBytes (path);
    json = nestsDeeply (text) ? Json () : Json::parse (text, nullptr, false);
  }
  catch (const IoError&)
  {
    // said below
  }
  if (!json.is_object ())
  {
    notes.warnings.push_back (path + ": is no JSON object");
    notes.whole = false;
  }
  return json;
}

/** \brief What stands in the way of showing anything. \param[in] error that the run's summary tells of */
void
requireRun (const std::string& folder, const std::string& error)
{
  const fs::path path (folder);
  if (isThere (path / "trajectory" / "camera.txt"))
    return;
  std::error_code ignored;
  if (!fs::is_directory (path, ignored))
    throw IoError (folder + ": is no folder; it must be what pcl_cosection_fusion or pcl_cosection wrote");
  if (!error.empty ())
    throw IoError (folder + ": that run failed: " + error);
  if (!isThere (path / "gt-cam-0.txt"))
    throw IoError (folder + ": has no trajectory/camera.txt: it is not what pcl_cosection_fusion or "
                            "pcl_cosection wrote, or that run did not come to its end");
}

void
loadTsdf (RunScene& scene, ReadingNotes& notes)
{
  for (const SceneRecord::Object& object : scene.run.objects)
  {
    const fs::path file = fs::path (scene.folder) / "mesh" / ("object_" + std::to_string (object.id) + "_tsdf.ply");
    if (!isThere (file))
      continue;
    try
    {
      scene.tsdf[object.id] = loadPlyMesh (file.string ());
    }
    catch (const Error& error)
    {
      notes.warnings.emplace_back (error.what ());
      notes.whole = false;
    }
  }
}

void
simplify (TriangleMesh& mesh, std::size_t triangles)
{
  if (triangles == 0 || mesh.triangles.size () <= triangles)
    return;
  try
  {
    mesh = decimate (mesh, triangles);
  }
  catch (const InvalidArgument&)
  {
    // no manifold: drawn as it is
  }
}

std::vector<double>
errorsOf (const TriangleMesh& mesh, const SurfaceDistance& truth, const Eigen::Isometry3d& T_truth_mesh, int threads)
{
  if (mesh.empty ())
    return {};
  return vertexDistances (transformMesh (mesh, T_truth_mesh), truth, threads);
}

} // namespace

std::vector<double>
RunScene::stamps () const
{
  std::vector<double> stamps;
  stamps.reserve (run.camera.size ());
  for (const StampedPose& pose : run.camera)
    stamps.push_back (pose.stamp);
  return stamps;
}

std::optional<Eigen::Isometry3d>
RunScene::cameraAt (double stamp) const
{
  return nearestPose (run.camera, stamp, 0.5 * stampPeriod (stamps ()));
}

std::optional<Eigen::Isometry3d>
RunScene::poseAt (const SceneRecord::Object& object, double stamp) const
{
  return nearestPose (object.poses, stamp, 0.5 * stampPeriod (stamps ()));
}

const TriangleMesh&
RunScene::surface (int id, SurfaceMode mode) const
{
  static const TriangleMesh none;
  if (mode == SurfaceMode::Points)
    return none;
  if (id == background)
    return run.background;
  if (mode == SurfaceMode::Tsdf)
  {
    const auto found = tsdf.find (id);
    return found == tsdf.end () ? none : found->second;
  }
  const auto object = std::find_if (run.objects.begin (), run.objects.end (),
                                    [id] (const auto& o) { return o.id == id; });
  return object == run.objects.end () ? none : object->mesh;
}

const std::vector<double>&
RunScene::surfaceErrors (int id, SurfaceMode mode) const
{
  static const std::vector<double> none;
  const auto found = errors.find (id);
  if (found == errors.end () || mode == SurfaceMode::Points)
    return none;
  return mode == SurfaceMode::Tsdf && id != background ? found->second.tsdf : found->second.completed;
}

PinholeCamera
RunScene::camera () const
{
  return run.intrinsics.value_or (usual_camera);
}

RunScene
loadRunScene (const std::string& folder, ReadingNotes& notes, const RunSceneOptions& options)
{
  const std::optional<Json> summary = readSummary (folder, notes);
  const Json json = summary.value_or (Json ());
  RunScene scene;
  scene.folder = folder;
  scene.of_views = isCompletion (folder, json);
  if (scene.of_views)
    scene.run = readCompletion (folder, json, notes);
  else
  {
    requireRun (folder, textOf (json, "error"));
    scene.run = readRun (folder, notes);
    scene.run.intrinsics = cameraOf (fieldOf (json, "camera"));
  }
  scene.classes = classesOf (fieldOf (json, "objects"));
  scene.up = firstNormalOf (fieldOf (json, "support_planes"));
  const Json& parameters = fieldOf (json, "parameters");
  scene.dataset = textOf (parameters, "dataset");
  scene.source = sourceOf (fieldOf (parameters, "images"));
  loadTsdf (scene, notes);
  simplify (scene.run.background, options.triangles);
  for (SceneRecord::Object& object : scene.run.objects)
    simplify (object.mesh, options.triangles / 2);
  for (auto& [id, mesh] : scene.tsdf)
    simplify (mesh, options.triangles / 2);
  if (!summary && !scene.of_views)
    notes.warnings.push_back (folder + ": has no summary.json: the run did not come to its end");
  return scene;
}

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
