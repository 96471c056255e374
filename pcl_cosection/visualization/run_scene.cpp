// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/run_scene.h>

#include "run_summary.h"

#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

/** \brief What the camera is taken for if it is not known. */
constexpr PinholeCamera usual_camera = {640, 480, 525.0, 525.0, 319.5, 239.5};

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

/** \brief What stands in the way of showing anything. */
void
requireRun (const std::string& folder, const RunSummary& summary)
{
  const fs::path path (folder);
  if (!isThere (path / "trajectory" / "camera.txt") && !summary.error.empty ())
    throw IoError (folder + ": that run failed: " + summary.error);
  std::error_code ignored;
  if (fs::is_directory (path, ignored) && !isThere (path / "trajectory" / "camera.txt") &&
      !isThere (path / "gt-cam-0.txt"))
    throw IoError (folder + ": has no trajectory/camera.txt: it is not what pcl_cosection_fusion wrote, or that run "
                            "did not come to its end");
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
  const RunSummary summary = readRunSummary (folder, notes);
  requireRun (folder, summary);
  RunScene scene;
  scene.folder = folder;
  scene.run = readRun (folder, notes);
  scene.run.intrinsics = summary.camera;
  scene.classes = summary.classes;
  scene.dataset = summary.dataset;
  scene.source = summary.source;
  loadTsdf (scene, notes);
  simplify (scene.run.background, options.triangles);
  for (SceneRecord::Object& object : scene.run.objects)
    simplify (object.mesh, options.triangles / 2);
  for (auto& [id, mesh] : scene.tsdf)
    simplify (mesh, options.triangles / 2);
  if (!summary.is_there)
    notes.warnings.push_back (folder + ": has no summary.json: the run did not come to its end");
  return scene;
}

} // namespace pcl::cosection
