// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/json_depth.h"
#include <pcl/cosection/visualization/scene_picture.h>

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

using Json = nlohmann::ordered_json;

constexpr double raised_rad = 0.25;                             ///< the overview, above the cameras
constexpr double least_raised_rad = 0.4, most_raised_rad = 1.0; ///< above the floor
constexpr double upward = 0.6;         ///< cosine of the angle up to which a normal may be the floor's
constexpr double floor_share = 0.1;    ///< of the vertices, for a floor
constexpr double behind_cameras = 1.8; ///< of their distance
constexpr double beyond = 1.15;        ///< room around what is to be seen
constexpr double least_distance_m = 0.1;
constexpr double deepest_share = 0.02; ///< of a background's vertices, beyond its box at each end

/** \brief The corners of the objects' boxes, wherever the objects were. */
Eigen::AlignedBox3d
boxOfObjects (const RunScene& scene)
{
  Eigen::AlignedBox3d all;
  for (const SceneRecord::Object& object : scene.run.objects)
  {
    const TriangleMesh& mesh = object.mesh.empty () ? scene.surface (object.id, SurfaceMode::Tsdf) : object.mesh;
    if (mesh.vertices.empty ())
      continue;
    const Eigen::AlignedBox3d box = vertexBox (mesh);
    for (const StampedPose& pose : object.poses)
      for (int corner = 0; corner < 8; ++corner)
        all.extend (pose.pose * box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (corner)));
  }
  return all;
}

/** \brief How far from the middle of a box one sees all of it in a square picture. */
double
distanceToSee (const Eigen::AlignedBox3d& box, const Eigen::Vector3d& direction, const Viewpoint& view)
{
  const Eigen::Matrix3d R_camera_world = lookAt (direction, Eigen::Vector3d::Zero (), view.up).linear ().transpose ();
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d p = R_camera_world *
                              (box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (corner)) - box.center ());
    distance = std::max (distance, p.head<2> ().cwiseAbs ().maxCoeff () / std::tan (0.5 * view.angle_rad) - p.z ());
  }
  return distance;
}

/** \brief Where most of a mesh is. */
Eigen::AlignedBox3d
boxOfMost (const TriangleMesh& mesh)
{
  Eigen::Vector3d low, high;
  std::vector<float> values (mesh.vertices.size ());
  for (int axis = 0; axis < 3; ++axis)
  {
    std::transform (mesh.vertices.begin (), mesh.vertices.end (), values.begin (),
                    [axis] (const auto& v) { return v[axis]; });
    low[axis] = quantile (values, deepest_share);
    high[axis] = quantile (values, 1.0 - deepest_share);
  }
  return {low, high};
}

Eigen::Vector3d
vectorOf (const Json& json, const char* name, const std::string& path)
{
  const auto refuse = [&] { throw IoError (path + ": is no viewpoint: " + name + " must be three numbers"); };
  if (!json.contains (name) || !json[name].is_array () || json[name].size () != 3)
    refuse ();
  Eigen::Vector3d result;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (!json[name][axis].is_number ())
      refuse ();
    result[static_cast<Eigen::Index> (axis)] = json[name][axis].get<double> ();
  }
  return result;
}

Json
toJson (const Eigen::Vector3d& v)
{
  return {v.x (), v.y (), v.z ()};
}

} // namespace

Eigen::Isometry3d
Viewpoint::pose () const
{
  return lookAt (eye, target, up);
}

PinholeCamera
Viewpoint::camera (int width, int height) const
{
  const double focal_length = 0.5 * height / std::tan (0.5 * angle_rad);
  return {width, height, focal_length, focal_length, 0.5 * (width - 1), 0.5 * (height - 1)};
}

void
Viewpoint::validate () const
{
  const Eigen::Vector3d sight = target - eye;
  if (!eye.allFinite () || !target.allFinite () || !up.allFinite ())
    throw InvalidArgument ("eye, target and up must be finite numbers");
  if (!(sight.norm () > 0.0))
    throw InvalidArgument ("eye and target must be different places");
  if (!(sight.cross (up).norm () > 1e-6 * sight.norm () * up.norm ()))
    throw InvalidArgument ("up must be a direction, and not the one from eye to target");
  if (!(angle_rad > 1e-3 && angle_rad < M_PI - 1e-3))
    throw InvalidArgument ("the angle of view must be between 0 and 180 degrees");
}

Eigen::Vector3d
upDirection (const RunScene& scene)
{
  if (scene.up)
    return *scene.up;
  Eigen::Vector3d of_pictures = Eigen::Vector3d::Zero ();
  for (const StampedPose& pose : scene.run.camera)
    of_pictures -= pose.pose.linear ().col (1);
  if (!(of_pictures.norm () > 1e-6))
    of_pictures = {0.0, -1.0, 0.0};
  of_pictures.normalize ();
  Eigen::Vector3d of_floor = Eigen::Vector3d::Zero ();
  std::size_t count = 0;
  for (const Eigen::Vector3f& normal : scene.run.background.normals)
    if (normal.cast<double> ().dot (of_pictures) > upward)
    {
      of_floor += normal.cast<double> ();
      ++count;
    }
  const bool is_floor = static_cast<double> (count) >
                        floor_share * static_cast<double> (scene.run.background.normals.size ());
  return is_floor && of_floor.norm () > 1e-6 ? Eigen::Vector3d (of_floor.normalized ()) : of_pictures;
}

Viewpoint
overview (const RunScene& scene, double turn_rad, bool with_cameras)
{
  Eigen::AlignedBox3d box = boxOfObjects (scene);
  if (box.isEmpty () && !scene.run.background.vertices.empty ())
    box = boxOfMost (scene.run.background);
  Eigen::Vector3d camera = Eigen::Vector3d::Zero (), forward = Eigen::Vector3d::Zero ();
  for (const StampedPose& pose : scene.run.camera)
  {
    camera += pose.pose.translation () / static_cast<double> (scene.run.camera.size ());
    forward += pose.pose.linear ().col (2);
  }
  if (box.isEmpty ())
    box.extend (camera + forward.normalized ());
  Viewpoint view;
  view.target = box.center ();
  view.up = upDirection (scene);
  const Eigen::Vector3d back = camera - view.target;
  const double height = back.dot (view.up);
  Eigen::Vector3d level = back - height * view.up;
  double raised_rad_now = std::atan2 (height, level.norm ()) + raised_rad;
  if (!(level.norm () > 1e-6)) // right above: whichever way the pictures have at their lower edge
  {
    level = view.up.unitOrthogonal ();
    raised_rad_now = most_raised_rad;
  }
  raised_rad_now = std::clamp (raised_rad_now, least_raised_rad, most_raised_rad);
  const Eigen::Vector3d direction = std::cos (raised_rad_now) *
                                        (Eigen::AngleAxisd (turn_rad, view.up) * level.normalized ()) +
                                    std::sin (raised_rad_now) * view.up;
  const double least = with_cameras ? behind_cameras * back.norm () : least_distance_m;
  view.eye = view.target + std::max (beyond * distanceToSee (box, direction, view), least) * direction;
  return view;
}

PinholeCamera
fittedCamera (const PinholeCamera& camera, int width, int height)
{
  const double scale = std::min (static_cast<double> (width) / camera.width,
                                 static_cast<double> (height) / camera.height);
  // Pixel (u, v) covers the square around it.
  return {width,
          height,
          scale * camera.fx,
          scale * camera.fy,
          scale * (camera.cx + 0.5 - 0.5 * camera.width) + 0.5 * width - 0.5,
          scale * (camera.cy + 0.5 - 0.5 * camera.height) + 0.5 * height - 0.5};
}

void
saveViewpoint (const Viewpoint& viewpoint, const std::string& path)
{
  viewpoint.validate ();
  const Json json = {{"eye", toJson (viewpoint.eye)},
                     {"target", toJson (viewpoint.target)},
                     {"up", toJson (viewpoint.up)},
                     {"angle_deg", viewpoint.angle_rad * 180.0 / M_PI}};
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, json.dump (2) + "\n"); });
}

Viewpoint
loadViewpoint (const std::string& path)
{
  std::string text;
  try
  {
    text = readBytes (path);
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": cannot be read; it must be a viewpoint that the viewer saved: " + error.what ());
  }
  const Json json = nestsDeeply (text) ? Json () : Json::parse (text, nullptr, false);
  if (!json.is_object ())
    throw IoError (path + ": is no viewpoint: it must be a JSON object with eye, target, up and angle_deg");
  Viewpoint view;
  view.eye = vectorOf (json, "eye", path);
  view.target = vectorOf (json, "target", path);
  view.up = vectorOf (json, "up", path);
  if (!json.contains ("angle_deg") || !json["angle_deg"].is_number ())
    throw IoError (path + ": is no viewpoint: angle_deg must be a number");
  view.angle_rad = json["angle_deg"].get<double> () * M_PI / 180.0;
  try
  {
    view.validate ();
  }
  catch (const InvalidArgument& error)
  {
    throw IoError (path + ": is no viewpoint: " + error.what ());
  }
  return view;
}

} // namespace pcl::cosection
