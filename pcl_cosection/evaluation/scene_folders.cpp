// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_folders.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

constexpr int largest_image = 8192;
constexpr double same_pose = 1e-4; // relative: clouds have poses in single precision

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

/** \brief What \a read () returns; an empty value, and a warning that begins with \a whose, if it fails. */
template <typename Read>
auto
readOrWarn (ReadingNotes& notes, const std::string& whose, Read&& read) -> decltype (read ())
{
  try
  {
    return read ();
  }
  catch (const Error& error)
  {
    notes.warnings.push_back (whose + error.what ());
    notes.whole = false;
    return {};
  }
}

TriangleMesh
readTrueMesh (const std::string& path, ReadingNotes& notes)
{
  return readOrWarn (notes, "", [&] { return loadMesh (path); });
}

std::optional<PinholeCamera>
readCalibration (const std::string& path, ReadingNotes& notes)
{
  if (!fs::exists (path))
    return std::nullopt;
  return readOrWarn (notes, path + ": ", [&] {
    std::optional<PinholeCamera> camera = PinholeCamera{640, 480};
    std::istringstream file (readBytes (path));
    if (!(file >> camera->fx >> camera->fy >> camera->cx >> camera->cy))
      throw IoError ("must have the numbers fx fy cx cy [width height]");
    int width = 0, height = 0;
    if (file >> width >> height)
    {
      if (width < 1 || height < 1 || width > largest_image || height > largest_image)
        throw IoError ("has an image of " + std::to_string (width) + " x " + std::to_string (height) + " pixels");
      camera->width = width;
      camera->height = height;
    }
    camera->validate ();
    return camera;
  });
}

void
requireTruth (const std::string& folder)
{
  requireFolder (folder, "a dataset with truth: gt-cam-0.txt, gt-NAME-ID.txt and gt-mesh/NAME.ply");
  if (const std::string camera = inFolder (folder, "gt-cam-0.txt"); !fs::exists (camera))
    throw IoError (camera +
                   ": there is no such file; scenes with truth_LABEL.ply are for pcl_cosection_evaluate views");
}

/** \brief \param[in] poses folder of the trajectories */
SceneRecord
readTruth (const std::string& folder, const std::string& poses, ReadingNotes& notes)
{
  SceneRecord truth;
  truth.camera = loadTrajectory (inFolder (poses, "gt-cam-0.txt"));
  truth.intrinsics = readCalibration (inFolder (folder, "calibration.txt"), notes);
  for (const auto& file : matchingFiles (poses, std::regex ("gt-(.+)-([0-9]{1,9})\\.txt")))
  {
    if (file[1] == "cam" && file[2] == "0")
      continue;
    SceneRecord::Object object;
    object.id = std::stoi (file[2]);
    object.name = file[1];
    object.poses = readPosesOrWarn (file[0], notes);
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

} // namespace

std::vector<std::vector<std::string>>
matchingFiles (const std::string& folder, const std::regex& pattern)
{
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry (folder, error), end; entry != end; entry.increment (error))
    names.push_back (entry->path ().filename ().string ());
  std::sort (names.begin (), names.end ());
  std::vector<std::vector<std::string>> files;
  for (const std::string& name : names)
    if (std::smatch match; std::regex_match (name, match, pattern))
    {
      files.emplace_back (match.begin (), match.end ());
      files.back ().front () = inFolder (folder, name);
    }
  return files;
}

TriangleMesh
readMeshIfThere (const std::string& path, ReadingNotes& notes, const Eigen::Vector3d& origin)
{
  std::error_code failure;
  if (!fs::exists (path, failure) && !failure)
    return {};
  return readOrWarn (notes, "", [&] {
    TriangleMesh mesh;
    try
    {
      mesh = loadPlyMesh (path, origin);
    }
    catch (const IoError&) // not one of ours
    {
      mesh = loadMesh (path, origin);
    }
    requireSurface (mesh, path.c_str ());
    return mesh;
  });
}

std::vector<StampedPose>
readPosesOrWarn (const std::string& path, ReadingNotes& notes)
{
  return readOrWarn (notes, "", [&] { return loadTrajectory (path); });
}

SceneRecord
readRun (const std::string& folder, ReadingNotes& notes)
{
  requireFolder (folder, "what a run wrote, with trajectory/camera.txt and mesh/object_ID.ply");
  std::error_code ignored;
  if (!fs::exists (inFolder (folder, "trajectory"), ignored) && fs::exists (inFolder (folder, "gt-cam-0.txt"), ignored))
    throw IoError (folder + ": is a dataset, not what a run wrote; the run comes first, then the dataset");
  SceneRecord run;
  run.camera = loadTrajectory (inFolder (folder, "trajectory/camera.txt"));
  for (const auto& file : matchingFiles (inFolder (folder, "trajectory"), std::regex ("object_([0-9]{1,9})\\.txt")))
  {
    SceneRecord::Object object;
    object.id = std::stoi (file[1]);
    object.name = std::to_string (object.id);
    object.poses = readPosesOrWarn (file[0], notes);
    object.mesh = readMeshIfThere (inFolder (folder, "mesh/object_" + file[1] + ".ply"), notes);
    run.objects.push_back (std::move (object));
  }
  std::sort (run.objects.begin (), run.objects.end (), [] (const auto& a, const auto& b) { return a.id < b.id; });
  for (const auto& file : matchingFiles (inFolder (folder, "mesh"), std::regex ("object_([0-9]{1,9})\\.ply")))
    if (!fs::exists (inFolder (folder, "trajectory/object_" + file[1] + ".txt")))
      notes.warnings.push_back (file[0] + ": has no trajectory/object_" + file[1] + ".txt; it is left out");
  run.background = readMeshIfThere (inFolder (folder, "mesh/background.ply"), notes);
  return run;
}

SceneRecord
readTruth (const std::string& folder, ReadingNotes& notes)
{
  requireTruth (folder);
  return readTruth (folder, folder, notes);
}

SceneRecord
readTruthOfViews (const std::string& folder, const std::vector<StampedPose>& completed, ReadingNotes& notes)
{
  requireTruth (folder);
  const std::string views = inFolder (folder, "views");
  SceneRecord truth = readTruth (folder, fs::exists (inFolder (views, "gt-cam-0.txt")) ? views : folder, notes);
  std::map<double, double> stamps; // of the views by those of the truth
  for (const StampedPose& view : completed)
  {
    const auto isSame = [&] (const StampedPose& pose) {
      return pose.pose.isApprox (view.pose, same_pose) && stamps.count (pose.stamp) == 0;
    };
    auto found = std::find_if (truth.camera.begin (), truth.camera.end (), [&] (const StampedPose& pose) {
      return pose.stamp == view.stamp && isSame (pose); // first, as the camera may rest
    });
    if (found == truth.camera.end ())
      found = std::find_if (truth.camera.begin (), truth.camera.end (), isSame);
    if (found == truth.camera.end ())
      throw IoError (folder + ": has no frame that was taken from where view " +
                     std::to_string (static_cast<int> (view.stamp)) + " was: is it the truth of other views?");
    stamps[found->stamp] = view.stamp;
  }
  const auto restamp = [&] (std::vector<StampedPose>& poses) {
    std::vector<StampedPose> kept;
    for (const StampedPose& pose : poses)
      if (const auto stamp = stamps.find (pose.stamp); stamp != stamps.end ())
        kept.push_back ({stamp->second, pose.pose});
    std::sort (kept.begin (), kept.end (), [] (const auto& a, const auto& b) { return a.stamp < b.stamp; });
    poses = std::move (kept);
  };
  restamp (truth.camera);
  for (SceneRecord::Object& object : truth.objects)
    restamp (object.poses);
  return truth;
}

} // namespace pcl::cosection
