// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_folder.h"

#include "pcl_cosection/visualization/completed_scene.h"
#include "pcl_cosection/visualization/scene_summary.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <regex>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

/** \brief Names of the files in a folder, sorted; empty if there is no such folder. */
std::vector<std::string>
namesIn (const fs::path& folder)
{
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry (folder, failure), end; entry != end; entry.increment (failure))
    names.push_back (entry->path ().filename ().string ());
  std::sort (names.begin (), names.end ());
  return (names);
}

bool
hasAny (const fs::path& folder, const std::vector<std::string>& names)
{
  std::error_code failure;
  return (std::any_of (names.begin (), names.end (),
                       [&] (const std::string& name) { return (fs::exists (folder / name, failure)); }));
}

/** \brief Whether a file has one of the names that a run gives. */
bool
isRunFile (const std::string& name)
{
  static const std::regex pattern ("(background|object_[0-9]{1,9}(_tsdf)?)\\.ply|(camera|object_[0-9]{1,9})\\.txt");
  return (std::regex_match (name, pattern));
}

/** \throws IoError if nothing in the folder is of a run */
void
requireRun (const std::string& path)
{
  std::error_code failure;
  const fs::path folder (path);
  if (!fs::exists (folder, failure))
    throw IoError (path + ": there is no such folder; it must be what pcl_cosection_fusion or pcl_cosection wrote");
  if (!fs::is_directory (folder, failure))
    throw IoError (path + ": is a file; it must be the folder that pcl_cosection_fusion or pcl_cosection wrote");
  std::vector<std::string> names = namesIn (folder / "mesh");
  const std::vector<std::string> trajectories = namesIn (folder / "trajectory");
  names.insert (names.end (), trajectories.begin (), trajectories.end ());
  if (fs::is_regular_file (folder / "summary.json", failure) || std::any_of (names.begin (), names.end (), isRunFile))
    return;
  if (hasAny (folder, {"gt-cam-0.txt", "calibration.txt", "associations.txt", "rgb.txt", "depth", "depth_noise"}))
    throw IoError (path + ": is a dataset, not a run; first run pcl_cosection_fusion " + path +
                   " OUTPUT, then give OUTPUT" + (hasAny (folder, {"gt-cam-0.txt"}) ? ", and --truth " + path : ""));
  if (hasAny (folder, {"trajectory", "mesh"}) && !fs::is_empty (folder, failure))
    throw IoError (path + ": is a run in which nothing is left: no meshes, trajectories or summary.json");
  if (isCompletion (path, nlohmann::json ()))
    return;
  const std::vector<std::string> top = namesIn (folder);
  throw IoError (path +
                 (top.empty () ? ": is an empty folder"
                               : ": is not a result: it has neither summary.json nor mesh/ nor trajectory/") +
                 "; it must be what pcl_cosection_fusion or pcl_cosection wrote");
}

std::string
dateOf (const fs::path& file)
{
  struct stat status = {};
  if (stat (file.c_str (), &status) != 0)
    return ("");
  std::tm time = {};
  char text[32] = "";
  if (gmtime_r (&status.st_mtime, &time) != nullptr)
    std::strftime (text, sizeof (text), "%Y-%m-%d %H:%M UTC", &time);
  return (text);
}

template <typename Read>
void
tryToRead (RunFolder& run, Read&& read)
{
  try
  {
    read ();
  }
  catch (const Error& error)
  {
    run.notes.emplace_back (error.what ());
  }
}

void
readSummary (RunFolder& run)
{
  const fs::path path = fs::path (run.path) / "summary.json";
  std::error_code failure;
  if (!fs::exists (path, failure))
  {
    if (!isCompletion (run.path, nlohmann::json ())) // that says it itself
      run.notes.push_back (path.string () + " is missing: the run was interrupted, or these are not all of its files");
    return;
  }
  try
  {
    run.summary = readJsonObject (path.string ());
  }
  catch (const IoError& error)
  {
    run.notes.push_back (std::string (error.what ()) + "; its numbers are left out");
    return;
  }
  if (!run.summary.is_object ())
  {
    run.notes.push_back (path.string () + ": is not JSON as the programs write it; its numbers are left out");
    return;
  }
  run.failure = textIn (run.summary, "error");
  const Json& camera = member (run.summary, "camera");
  const auto number = [&] (const char* key) { return (numberIn (camera, key).value_or (0.0)); };
  const PinholeCamera intrinsics{static_cast<int> (std::clamp (number ("width"), 0.0, 1e5)),
                                 static_cast<int> (std::clamp (number ("height"), 0.0, 1e5)),
                                 number ("fx"),
                                 number ("fy"),
                                 number ("cx"),
                                 number ("cy")};
  if (intrinsics.width > 0 && intrinsics.height > 0 && intrinsics.fx > 0.0 && intrinsics.fy > 0.0)
    run.intrinsics = intrinsics;
}

TriangleMesh
readMesh (const fs::path& path)
{
  TriangleMesh mesh = loadPlyMesh (path.string ());
  requireSurface (mesh, path.c_str ());
  return (mesh);
}

/** \brief The entry of an object, which is made if it is missing. */
RunObject&
objectOf (std::map<int, RunObject>& objects, const std::string& number)
{
  const int id = std::stoi (number);
  RunObject& object = objects[id];
  object.id = id;
  return (object);
}

void
readRunFiles (RunFolder& run, std::map<int, RunObject>& objects)
{
  const fs::path folder (run.path), mesh = folder / "mesh", trajectory = folder / "trajectory";
  std::error_code failure;
  if (fs::exists (trajectory / "camera.txt", failure))
    tryToRead (run, [&] { run.camera = loadTrajectory ((trajectory / "camera.txt").string ()); });
  if (fs::exists (mesh / "background.ply", failure))
    tryToRead (run, [&] { run.background = readMesh (mesh / "background.ply"); });
  static const std::regex mesh_name ("object_([0-9]{1,9})(_tsdf)?\\.ply"),
      trajectory_name ("object_([0-9]{1,9})\\.txt");
  std::smatch match;
  for (const std::string& name : namesIn (trajectory))
    if (std::regex_match (name, match, trajectory_name))
      tryToRead (run, [&] { objectOf (objects, match[1]).poses = loadTrajectory ((trajectory / name).string ()); });
  for (const std::string& name : namesIn (mesh))
    if (std::regex_match (name, match, mesh_name))
      tryToRead (run, [&] {
        RunObject& object = objectOf (objects, match[1]);
        (match[2].matched ? object.seen : object.completed) = readMesh (mesh / name);
      });
}

/** \brief What pcl_cosection wrote, each view as a frame. */
void
readCompletedViews (const nlohmann::json& summary, RunFolder& run, std::map<int, RunObject>& objects)
{
  ReadingNotes notes;
  SceneRecord record = readCompletion (run.path, summary, notes);
  run.of_views = true;
  run.notes.insert (run.notes.end (), notes.warnings.begin (), notes.warnings.end ());
  run.camera = std::move (record.camera);
  run.intrinsics = record.intrinsics;
  run.background = std::move (record.background);
  for (SceneRecord::Object& object : record.objects)
    objects[object.id] = {object.id, std::move (object.poses), std::move (object.mesh), {}, {}};
}

void
noteWhatIsMissing (RunFolder& run)
{
  if (run.camera.empty ())
    run.notes.push_back (run.path + ": there is no trajectory of the camera");
  if (run.background.empty () && run.objects.empty ())
    run.notes.push_back (run.path + ": there are no meshes");
  for (const RunObject& object : run.objects)
  {
    const std::string name = "object " + std::to_string (object.id);
    if (object.completed.empty () && !run.of_views) // else what is missing is among its notes
      run.notes.push_back (name + " has no completed mesh");
    if (object.poses.empty () && !run.of_views)
      run.notes.push_back (name + " has no trajectory: it is shown in its own frame");
  }
}

} // namespace

RunFolder
readRunFolder (const std::string& path)
{
  requireRun (path);
  RunFolder run;
  run.path = path;
  readSummary (run);
  run.date = dateOf (fs::path (path) / "summary.json");
  std::map<int, RunObject> objects;
  if (const nlohmann::json summary = run.summary; isCompletion (path, summary))
    readCompletedViews (summary, run, objects);
  else
    readRunFiles (run, objects);
  const Json& entries = member (run.summary, "objects");
  if (entries.is_array ())
    for (const Json& entry : entries)
      if (const std::optional<double> id = numberIn (entry, "id"); id && *id >= 0.0 && *id < 1e9)
        objectOf (objects, std::to_string (static_cast<int> (*id))).summary = entry;
  for (auto& [id, object] : objects)
    run.objects.push_back (std::move (object));
  noteWhatIsMissing (run);
  return (run);
}

RunScene
sceneOf (const RunFolder& run)
{
  RunScene scene;
  scene.folder = run.path;
  scene.of_views = run.of_views;
  scene.up = firstNormalOf (nlohmann::json (member (run.summary, "support_planes")));
  scene.run.camera = run.camera;
  scene.run.intrinsics = run.intrinsics;
  scene.run.background = run.background;
  for (const RunObject& object : run.objects)
    if (!object.poses.empty ())
    {
      scene.run.objects.push_back ({object.id, std::to_string (object.id), object.poses, object.completed});
      if (!object.seen.empty ())
        scene.tsdf[object.id] = object.seen;
    }
  return (scene);
}
