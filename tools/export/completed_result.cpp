// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completed_result.h"

#include "json_fields.h"

#include "pcl_cosection/common/json_pose.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <sstream>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

const char* const who_wrote_it = "what pcl_cosection or pcl_cosection_fusion wrote into a folder";

/** \brief The name with the ending of a format, else the first of the others that is there; empty: there is no such
 * file. */
std::string
existing (const fs::path& stem, const std::string& format)
{
  std::error_code failure;
  for (const std::string& ending : {format, std::string ("ply"), std::string ("obj"), std::string ("stl")})
    if (const std::string name = stem.string () + "." + ending; !ending.empty () && fs::exists (name, failure))
      return (name);
  return ("");
}

/** \brief Relative to \a origin, as STL files are already. */
TriangleMesh
readSurface (const std::string& path, const Eigen::Vector3d& origin)
{
  const fs::path ending = fs::path (path).extension ();
  return (ending == ".ply" ? loadPlyMesh (path, origin)
                           : loadMesh (path, ending == ".stl" ? Eigen::Vector3d::Zero ().eval () : origin));
}

/** \brief The numbers of a list of \a size; nothing if it is anything else. */
std::vector<double>
numbersOf (const Json& list, std::size_t size)
{
  std::vector<double> numbers;
  if (list.is_array () && list.size () == size)
    for (const Json& value : list)
      if (value.is_number () && std::isfinite (value.get<double> ()))
        numbers.push_back (value.get<double> ());
  return (numbers.size () == size ? numbers : std::vector<double> ());
}

Json
readSummary (const fs::path& folder)
{
  std::error_code failure;
  if (!fs::exists (folder, failure))
    throw IoError (folder.string () + ": there is no such folder; it must be " + who_wrote_it);
  if (!fs::is_directory (folder, failure))
    throw IoError (folder.string () + ": is a file; it must be " + who_wrote_it);
  const std::string path = (folder / "summary.json").string ();
  if (!fs::exists (path, failure))
    throw IoError (path + ": is missing; the folder must be " + who_wrote_it);
  Json summary = readJsonObject (path);
  if (!member (summary, "objects").is_array ())
    throw IoError (path + ": is not JSON as pcl_cosection and pcl_cosection_fusion write it");
  return (summary);
}

std::vector<Eigen::Vector4d>
planesOf (const Json& summary, const Eigen::Vector3d& origin, const std::string& path)
{
  std::vector<Eigen::Vector4d> planes;
  const Json& list = member (summary, "support_planes");
  if (!list.is_null () && !list.is_array ())
    throw IoError (path + ": support_planes must be lists of four numbers");
  if (list.is_array ())
    for (const Json& entry : list)
    {
      const std::vector<double> numbers = numbersOf (entry, 4);
      if (numbers.empty ())
        throw IoError (path + ": support_planes must be lists of four numbers");
      Eigen::Vector4d plane (numbers[0], numbers[1], numbers[2], numbers[3]);
      constexpr double shortest = 1e-6; // normals are written with a length of 1
      const double length = plane.head<3> ().norm ();
      if (!(length > shortest) || !std::isfinite (length))
        throw IoError (path + ": support_planes has a normal without length");
      plane /= length;
      plane[3] += plane.head<3> ().dot (origin);
      planes.push_back (plane);
    }
  return (planes);
}

/** \brief The pose of an object in the last view in which it is known. */
std::optional<Eigen::Isometry3d>
lastPose (const Json& views, const std::string& number)
{
  std::optional<Eigen::Isometry3d> last;
  if (views.is_array ())
    for (const Json& view : views)
      if (const auto pose = poseFromRows (member (member (view, "T_world_object"), number)))
        last = pose;
  return (last);
}

/** \brief The last pose of an object that moves, if there is one. */
void
readPose (const fs::path& folder, const Json& summary, bool is_tracked, CompletedObject& object,
          CompletedResult& result)
{
  const std::string number = std::to_string (object.id);
  std::error_code failure;
  std::string path = (folder / "trajectory" / ("object_" + number + ".txt")).string ();
  const bool is_there = fs::exists (path, failure);
  if (!is_there && is_tracked)
    throw IoError (path + ": is missing, though summary.json says that the object was tracked");
  if (const auto pose = lastPose (member (summary, "views"), number); pose && !is_there)
  {
    object.T_world_object = *pose;
    return;
  }
  if (!is_there) // a result of an earlier version
    path = textIn (member (member (summary, "parameters"), "object_trajectories"), number);
  if (path.empty ())
    return;
  const std::vector<StampedPose> poses = loadTrajectory (path);
  object.T_world_object = poses.back ().pose;
  result.files.push_back (path);
}

/** \brief An entry of summary.json. */
CompletedObject
readEntry (const Json& entry, const std::string& path)
{
  const std::optional<double> id = numberIn (entry, "id");
  if (!id || !(*id >= 0.0 && *id < 1e9) || *id != std::floor (*id))
    throw IoError (path + ": an object has no id");
  CompletedObject object;
  object.id = static_cast<int> (*id);
  object.label = textIn (entry, "class");
  object.voxel_size_m = numberIn (entry, "voxel_size_m").value_or (0.0);
  return (object);
}

/** \brief Find out whether voxels and coordinates fit a mesh. */
void
checkLengths (const CompletedObject& object, const std::string& mesh, std::vector<std::string>& warnings)
{
  constexpr double smallest_share = 1e-5, noticeable_share = 1e-3; // of its size
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : object.mesh.vertices)
    box.extend (vertex.cast<double> ());
  const double size = box.diagonal ().norm ();
  if (const double voxel = object.voxel_size_m; voxel != 0.0 && !(voxel > smallest_share * size && voxel < size))
    throw IoError (mesh + ": cannot have voxels of the voxel_size_m in summary.json");
  const double farthest = std::max (box.min ().cwiseAbs ().maxCoeff (), box.max ().cwiseAbs ().maxCoeff ());
  if (const double rounding = farthest * std::numeric_limits<float>::epsilon (); rounding > noticeable_share * size)
  {
    std::ostringstream text;
    text.precision (3);
    text << mesh << ": is so far from its origin that its coordinates are rounded to " << 1000.0 * rounding << " mm";
    warnings.push_back (text.str ());
  }
}

} // namespace

CompletedResult
readCompletedResult (const std::string& folder_name)
{
  const fs::path folder (folder_name);
  const Json summary = readSummary (folder);
  const std::string path = (folder / "summary.json").string ();
  if (const std::string failure = textIn (summary, "error"); !failure.empty ())
    throw IoError (path + ": is of a run that failed: " + failure);
  CompletedResult result;
  result.files.push_back (path);
  std::error_code failure;
  const std::string format = textIn (member (summary, "parameters"), "format");
  const fs::path meshes = fs::is_directory (folder / "mesh", failure) ? folder / "mesh" : folder;
  if (const Json& given = member (summary, "origin_m"); !given.is_null ())
  {
    const std::vector<double> origin = numbersOf (given, 3);
    if (origin.empty ())
      throw IoError (path + ": origin_m must be a list of three numbers");
    result.origin = Eigen::Vector3d (origin[0], origin[1], origin[2]);
  }
  result.scene.planes = planesOf (summary, result.origin, path);
  const Json& failed = member (summary, "failed");
  if (failed.is_array () && !failed.empty ())
    result.warnings.push_back (path + ": " + std::to_string (failed.size ()) +
                               " objects could not be completed; they are left out");
  for (const Json& entry : member (summary, "objects"))
  {
    CompletedObject object = readEntry (entry, path);
    const std::string stem = (meshes / ("object_" + std::to_string (object.id))).string ();
    const std::string mesh = existing (stem, format);
    if (mesh.empty ())
      throw IoError (stem + ".ply: is missing, though summary.json has object " + std::to_string (object.id));
    readPose (folder, summary, numberIn (entry, "frames_tracked").value_or (0.0) > 0.0, object, result);
    const bool moves = !object.T_world_object.isApprox (Eigen::Isometry3d::Identity (), 0.0);
    const Eigen::Vector3d origin = moves ? Eigen::Vector3d::Zero () : result.origin;
    object.mesh = readSurface (mesh, origin);
    if (!computeTopology (object.mesh).closed_manifold)
      throw IoError (mesh + ": is not a closed surface; an open one has no volume");
    result.files.push_back (mesh);
    checkLengths (object, mesh, result.warnings);
    if (const std::string outer = existing (stem + "_outer", format); !outer.empty ())
    {
      object.outer = readSurface (outer, origin);
      result.files.push_back (outer);
    }
    result.scene.objects.push_back (std::move (object));
  }
  if (result.scene.objects.empty ())
    throw IoError (path + ": has no objects");
  if (const std::string background = existing ((meshes / "background").string (), format); !background.empty ())
  {
    result.scene.background = readSurface (background, result.origin);
    result.files.push_back (background);
  }
  return (result);
}
