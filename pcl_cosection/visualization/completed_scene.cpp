// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completed_scene.h"

#include "scene_summary.h"

#include "pcl_cosection/evaluation/scene_folders.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <algorithm>
#include <filesystem>
#include <regex>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

const std::regex mesh_name ("object_([0-9]{1,9})\\.(ply|stl|obj)");
constexpr double few_sides = 0.2;      ///< length of the mean normal from which on surfaces were seen from one side
constexpr double sizes_away = 2.0;     ///< of a camera that is not known, in diagonals of what it sees
constexpr double least_size_m = 0.001; ///< of what it sees

/** \brief A camera before most of what was observed. */
Eigen::Isometry3d
assumedCamera (const std::vector<SceneRecord::Object>& objects)
{
  Eigen::AlignedBox3d box;
  Eigen::Vector3d towards = Eigen::Vector3d::Zero ();
  double count = 0.0;
  for (const SceneRecord::Object& object : objects)
  {
    const TriangleMesh& mesh = object.mesh;
    if (!mesh.empty ())
      box.extend (vertexBox (mesh));
    for (std::size_t n = 0; n < mesh.normals.size () && n < mesh.provenance.size (); ++n)
      if (mesh.provenance[n] == static_cast<std::uint8_t> (Provenance::Observed))
      {
        towards += mesh.normals[n].cast<double> ();
        ++count;
      }
  }
  if (!(towards.norm () > few_sides * count))
    towards = {0.0, 0.0, -1.0};
  const Eigen::Vector3d centre = box.isEmpty () ? Eigen::Vector3d::Zero () : Eigen::Vector3d (box.center ());
  const double size = box.isEmpty () ? 0.0 : box.diagonal ().norm ();
  const Eigen::Vector3d eye = centre + sizes_away * std::max (size, least_size_m) * towards.normalized ();
  return lookAt (eye, centre, -Eigen::Vector3d::UnitY ());
}

/** \brief Where the sensors were; the intrinsics are those of the first. */
void
readViews (const Json& summary, const Eigen::Vector3d& origin, SceneRecord& record)
{
  const Json& views = fieldOf (summary, "views");
  if (!views.is_array ())
    return;
  for (const Json& view : views)
  {
    std::optional<Eigen::Isometry3d> pose = poseOf (view, "T_world_sensor");
    if (!pose)
      continue;
    pose->pretranslate (-origin);
    if (record.camera.empty ())
      record.intrinsics = cameraOf (fieldOf (view, "camera"));
    record.camera.push_back ({static_cast<double> (record.camera.size ()), *pose});
  }
}

/** \brief The poses of an object that moves; else one per view, the origin of the world. */
std::vector<StampedPose>
posesOf (const std::string& trajectory, const Eigen::Vector3d& origin, const SceneRecord& record, ReadingNotes& notes)
{
  std::vector<StampedPose> poses;
  if (!trajectory.empty ())
    poses = readPosesOrWarn (trajectory, notes);
  else
    for (const StampedPose& camera : record.camera)
      poses.push_back ({camera.stamp, Eigen::Isometry3d::Identity ()});
  if (!trajectory.empty ())
    for (StampedPose& pose : poses)
      pose.pose.pretranslate (-origin);
  return poses;
}

} // namespace

bool
isCompletion (const std::string& folder, const Json& summary)
{
  std::error_code ignored;
  return !fs::exists (fs::path (folder) / "trajectory" / "camera.txt", ignored) &&
         (fieldOf (summary, "views").is_array () || !matchingFiles (folder, mesh_name).empty ());
}

SceneRecord
readCompletion (const std::string& folder, const Json& summary, ReadingNotes& notes)
{
  const std::vector<double> given = numbersOf (summary, "origin_m", 3);
  const Eigen::Vector3d origin = given.empty () ? Eigen::Vector3d::Zero () : Eigen::Vector3d (given.data ());
  const Json& trajectories = fieldOf (fieldOf (summary, "parameters"), "object_trajectories");
  SceneRecord record;
  readViews (summary, origin, record);
  for (const auto& file : matchingFiles (folder, mesh_name))
  {
    SceneRecord::Object object;
    object.id = std::stoi (file[1]);
    object.name = file[1];
    const std::string trajectory = textOf (trajectories, file[1].c_str ());
    object.mesh = readMeshIfThere (file[0], notes, trajectory.empty () ? origin : Eigen::Vector3d::Zero ());
    object.poses = posesOf (trajectory, origin, record, notes);
    record.objects.push_back (std::move (object));
  }
  std::sort (record.objects.begin (), record.objects.end (), [] (const auto& a, const auto& b) { return a.id < b.id; });
  for (const char* name : {"background.ply", "background.stl", "background.obj"})
    if (record.background.empty ())
      record.background = readMeshIfThere ((fs::path (folder) / name).string (), notes, origin);
  if (record.camera.empty ())
  {
    notes.warnings.push_back (folder + ": its summary.json does not say from where it was seen; a place is assumed");
    record.camera.push_back ({0.0, assumedCamera (record.objects)});
    for (SceneRecord::Object& object : record.objects)
      if (object.poses.empty ())
        object.poses.push_back ({0.0, Eigen::Isometry3d::Identity ()});
  }
  return record;
}

} // namespace pcl::cosection
