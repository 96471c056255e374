// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completed_scene.h"

#include "scene_summary.h"

#include "pcl_cosection/common/json_pose.h"
#include "pcl_cosection/evaluation/scene_folders.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

const std::regex mesh_name ("object_([0-9]{1,9})\\.(ply|stl|obj)");
constexpr std::uint64_t most_objects = 1000000000; ///< their ids
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

/** \brief The identity in each frame, for an object that rests. */
std::vector<StampedPose>
atRest (const SceneRecord& record)
{
  std::vector<StampedPose> poses;
  for (const StampedPose& camera : record.camera)
    poses.push_back ({camera.stamp, Eigen::Isometry3d::Identity ()});
  return poses;
}

/** \brief Reads what pcl_cosection wrote. */
class Completion
{
public:
  Completion (const std::string& folder, const Json& summary, ReadingNotes& notes)
      : folder_ (folder)
      , summary_ (summary)
      , notes_ (notes)
  {
    const std::vector<double> given = numbersOf (summary, "origin_m", 3);
    if (!given.empty () && isPlace (Eigen::Vector3d (given.data ())))
      origin_ = Eigen::Vector3d (given.data ());
    else if (!fieldOf (summary, "origin_m").is_null ())
      warn (": its summary.json has no origin_m that is a place");
  }

  SceneRecord read ()
  {
    readViews ();
    for (const int id : objects ())
      readObject (id);
    for (const std::string& ending : endings ())
      if (record_.background.empty ())
        record_.background = readMesh ("background." + ending, origin_);
    if (record_.camera.empty ())
    {
      warn (": its summary.json does not say from where it was seen; a place is assumed");
      record_.camera.push_back ({0.0, assumedCamera (record_.objects)});
      record_.intrinsics = usual_camera;
    }
    for (SceneRecord::Object& object : record_.objects)
      if (moving_.count (object.id) == 0)
        object.poses = atRest (record_);
    return std::move (record_);
  }

private:
  void warn (const std::string& text) { notes_.warnings.push_back (folder_ + text); }

  /** \brief Where the sensors were, one place per INPUT; the intrinsics are those of the first. */
  void readViews ()
  {
    const Json& views = fieldOf (summary_, "views");
    if (!views.is_array ())
      return;
    std::map<double, const Json*> first; // of each INPUT: sensors that see all around have several
    for (const Json& view : views)
    {
      const Json& number = fieldOf (view, "input");
      if (poseFromRows (fieldOf (view, "T_world_sensor")))
        first.emplace (number.is_number_unsigned () ? number.get<double> () : static_cast<double> (first.size ()),
                       &view);
    }
    for (const auto& [stamp, view] : first)
    {
      if (record_.camera.empty ())
        record_.intrinsics = cameraOf (fieldOf (*view, "camera"));
      record_.camera.push_back ({stamp, inFrame (*poseFromRows (fieldOf (*view, "T_world_sensor")))});
      const Json& objects = fieldOf (*view, "T_world_object");
      if (objects.is_object ())
        for (const auto& [id, rows] : objects.items ())
          if (const std::optional<Eigen::Isometry3d> pose = poseFromRows (rows))
            moves_[id].push_back ({stamp, inFrame (*pose)});
    }
  }

  Eigen::Isometry3d inFrame (Eigen::Isometry3d pose) const { return pose.pretranslate (-origin_); }

  /** \brief Those of the summary; without one, those that have a mesh. */
  std::set<int> objects ()
  {
    std::set<int> there, listed;
    for (const auto& file : matchingFiles (folder_, mesh_name))
      there.insert (std::stoi (file[1]));
    const Json& entries = fieldOf (summary_, "objects");
    if (!entries.is_array ())
      return there;
    for (const Json& entry : entries)
      if (const Json& id = fieldOf (entry, "id"); id.is_number_unsigned () && id.get<std::uint64_t> () < most_objects)
        listed.insert (id.get<int> ());
    for (const int id : there)
      if (listed.count (id) == 0)
        warn (": has a mesh of object " + std::to_string (id) + ", of which summary.json says nothing; it is left out");
    return listed;
  }

  /** \brief The format of the meshes first, if the summary has it. */
  std::vector<std::string> endings () const
  {
    std::vector<std::string> endings = {"ply", "stl", "obj"};
    const std::string format = textOf (fieldOf (summary_, "parameters"), "format");
    std::stable_partition (endings.begin (), endings.end (), [&] (const std::string& e) { return e == format; });
    return endings;
  }

  /** \brief Relative to \a origin, as STL files are already. */
  TriangleMesh readMesh (const std::string& name, const Eigen::Vector3d& origin)
  {
    const bool is_relative = fs::path (name).extension () == ".stl";
    return readMeshIfThere ((fs::path (folder_) / name).string (), notes_,
                            is_relative ? Eigen::Vector3d::Zero () : origin);
  }

  void readObject (int id)
  {
    SceneRecord::Object object;
    object.id = id;
    object.name = std::to_string (id);
    const std::string trajectory = textOf (fieldOf (fieldOf (summary_, "parameters"), "object_trajectories"),
                                           object.name.c_str ());
    const bool moves = !trajectory.empty () || moves_.count (object.name) > 0;
    const std::size_t warnings = notes_.warnings.size ();
    for (const std::string& ending : endings ())
      if (object.mesh.empty ())
        object.mesh = readMesh ("object_" + object.name + "." + ending, moves ? Eigen::Vector3d::Zero () : origin_);
    if (object.mesh.empty () && notes_.warnings.size () == warnings)
      warn (": the mesh of object " + object.name + " is missing");
    if (moves)
    {
      moving_.insert (id);
      object.poses = moves_[object.name];
      if (object.poses.empty ())
        warn (": its summary.json does not say where object " + object.name + " was; it is not shown");
    }
    record_.objects.push_back (std::move (object));
  }

  const std::string folder_;
  const Json& summary_;
  ReadingNotes& notes_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero ();
  std::map<std::string, std::vector<StampedPose>> moves_; ///< poses by object
  std::set<int> moving_;                                  ///< objects that do not rest
  SceneRecord record_;
};

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
  return Completion (folder, summary, notes).read ();
}

} // namespace pcl::cosection
