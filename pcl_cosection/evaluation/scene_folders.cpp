// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/run_evaluation.h>

#include "surface_samples.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

constexpr int largest_image = 8192;

void
requireFolder (const std::string& folder, const std::string& what)
{
  std::error_code error;
  if (!fs::is_directory (folder, error))
    throw IoError (folder + ": is no folder; it must be " + what);
}

std::string
inFolder (const std::string& folder, const std::string& name)
{
  return (fs::path (folder) / name).string ();
}

/** \brief The files of a folder whose names match, with what the groups of the pattern are, by name. */
std::vector<std::pair<std::string, std::smatch>>
matchingFiles (const std::string& folder, const std::regex& pattern, std::vector<std::string>& names)
{
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator (folder, error))
    names.push_back (entry.path ().filename ().string ());
  std::sort (names.begin (), names.end ());
  std::vector<std::pair<std::string, std::smatch>> files;
  for (const std::string& name : names)
  {
    std::smatch match;
    if (std::regex_match (name, match, pattern))
      files.emplace_back (inFolder (folder, name), match);
  }
  return files;
}

/** \brief A mesh with its provenance if it has one; empty, and a warning, if it cannot be read. */
TriangleMesh
readMesh (const std::string& path, ReadingNotes& notes)
{
  try
  {
    TriangleMesh mesh;
    try
    {
      mesh = loadPlyMesh (path);
    }
    catch (const IoError&) // not one of ours
    {
      mesh = loadMesh (path);
    }
    requireSurface (mesh, path.c_str ());
    return mesh;
  }
  catch (const Error& error)
  {
    notes.warnings.emplace_back (error.what ());
    notes.whole = false;
    return TriangleMesh ();
  }
}

TriangleMesh
readTrueMesh (const std::string& path, ReadingNotes& notes)
{
  try
  {
    return loadMesh (path);
  }
  catch (const Error& error)
  {
    notes.warnings.emplace_back (error.what ());
    notes.whole = false;
    return TriangleMesh ();
  }
}

/** \brief The pose of each time; none, and a warning, if the file cannot be read. */
std::vector<StampedPose>
readPoses (const std::string& path, ReadingNotes& notes)
{
  try
  {
    return loadTrajectory (path);
  }
  catch (const Error& error)
  {
    notes.warnings.emplace_back (error.what ());
    notes.whole = false;
    return std::vector<StampedPose> ();
  }
}

std::optional<PinholeCamera>
readCalibration (const std::string& path, ReadingNotes& notes)
{
  if (!fs::exists (path))
    return std::nullopt;
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  std::ifstream file (path);
  try
  {
    if (!(file >> camera.fx >> camera.fy >> camera.cx >> camera.cy))
      throw IoError ("must have the numbers fx fy cx cy [width height]");
    int width = 0, height = 0;
    if (file >> width >> height)
    {
      if (width < 1 || height < 1 || width > largest_image || height > largest_image)
        throw IoError ("has an image of " + std::to_string (width) + " x " + std::to_string (height) + " pixels");
      camera.width = width;
      camera.height = height;
    }
    camera.validate ();
    return camera;
  }
  catch (const Error& error)
  {
    notes.warnings.push_back (path + ": " + error.what ());
    notes.whole = false;
    return std::nullopt;
  }
}

} // namespace

SceneRecord
readRun (const std::string& folder, ReadingNotes& notes)
{
  requireFolder (folder, "what a run wrote, with trajectory/camera.txt and mesh/object_ID.ply");
  std::error_code ignored;
  if (!fs::exists (inFolder (folder, "trajectory"), ignored) && fs::exists (inFolder (folder, "gt-cam-0.txt"), ignored))
    throw IoError (folder + ": is a dataset, not what a run wrote; the run comes first, then the dataset");
  SceneRecord run;
  run.camera = loadTrajectory (inFolder (folder, "trajectory/camera.txt"));
  std::vector<std::string> names;
  const auto trajectories = matchingFiles (inFolder (folder, "trajectory"), std::regex ("object_([0-9]{1,9})\\.txt"),
                                           names);
  for (const auto& [path, match] : trajectories)
  {
    SceneRecord::Object object;
    object.id = std::stoi (match[1]);
    object.name = std::to_string (object.id);
    object.poses = readPoses (path, notes);
    const std::string mesh = inFolder (folder, "mesh/object_" + match[1].str () + ".ply");
    if (fs::exists (mesh))
      object.mesh = readMesh (mesh, notes);
    run.objects.push_back (std::move (object));
  }
  std::sort (run.objects.begin (), run.objects.end (), [] (const auto& a, const auto& b) { return a.id < b.id; });
  std::vector<std::string> mesh_names;
  for (const auto& [path, match] :
       matchingFiles (inFolder (folder, "mesh"), std::regex ("object_([0-9]{1,9})\\.ply"), mesh_names))
    if (!fs::exists (inFolder (folder, "trajectory/object_" + match[1].str () + ".txt")))
      notes.warnings.push_back (path + ": has no trajectory/object_" + match[1].str () + ".txt; it is left out");
  const std::string background = inFolder (folder, "mesh/background.ply");
  if (fs::exists (background))
    run.background = readMesh (background, notes);
  return run;
}

SceneRecord
readTruth (const std::string& folder, ReadingNotes& notes)
{
  requireFolder (folder, "a dataset with truth: gt-cam-0.txt, gt-NAME-ID.txt and gt-mesh/NAME.ply");
  SceneRecord truth;
  truth.camera = loadTrajectory (inFolder (folder, "gt-cam-0.txt"));
  truth.intrinsics = readCalibration (inFolder (folder, "calibration.txt"), notes);
  std::vector<std::string> names;
  for (const auto& [path, match] : matchingFiles (folder, std::regex ("gt-(.+)-([0-9]{1,9})\\.txt"), names))
  {
    if (match[1] == "cam" && match[2] == "0")
      continue;
    SceneRecord::Object object;
    object.id = std::stoi (match[2]);
    object.name = match[1];
    object.poses = readPoses (path, notes);
    const std::string mesh = inFolder (folder, "gt-mesh/" + object.name + ".ply");
    if (fs::exists (mesh))
      object.mesh = readTrueMesh (mesh, notes);
    truth.objects.push_back (std::move (object));
  }
  for (const char* name : {"gt-mesh/room.ply", "gt-mesh/background.ply"})
    if (truth.background.empty () && fs::exists (inFolder (folder, name)))
      truth.background = readTrueMesh (inFolder (folder, name), notes);
  return truth;
}

} // namespace pcl::cosection
