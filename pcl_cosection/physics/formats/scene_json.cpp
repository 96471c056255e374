// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_json.h"

#include "scene_geometry.h"
#include "scene_writers.h"

namespace pcl::cosection {
namespace {

using Json = nlohmann::ordered_json;

Json
poseJson (const Eigen::Isometry3d& pose)
{
  return {{"position", toJson (pose.translation ())}, {"quaternion_xyzw", toJson (rotationOf (pose).coeffs ())}};
}

/** \brief The URDF file of a body or plane; null if that format was not asked for. */
Json
urdfOf (const std::string& name, const SceneFolder& folder)
{
  return folder.has (name + ".urdf") ? Json (name + ".urdf") : Json ();
}

Json
bodyJson (const PhysicalBody& body, const PhysicalScene& scene, const SceneFolder& folder)
{
  Json json = {{"name", body.name},
               {"id", body.id},
               {"urdf", urdfOf (body.name, folder)},
               {"T_scene_body", poseJson (body.T_scene_body)},
               {"static", body.isStatic ()},
               {"mass_kg", body.mass_kg},
               {"centre_m", toJson (body.centre_m)},
               {"inertia", toJson (body.inertia)},
               {"volume_m3", body.volume_m3},
               {"parts", body.parts.size ()},
               {"convex", body.convex},
               {"parts_volume_m3", body.parts_volume_m3},
               {"excess_m", body.excess_m},
               {"missing_m", body.missing_m},
               {"stands_on", nullptr},
               {"centre_shift_m", body.centre_shift_m}};
  if (body.stands_on >= 0)
    json["stands_on"] = scene.planes.at (static_cast<std::size_t> (body.stands_on)).name;
  return json;
}

} // namespace

Json
toJson (const Eigen::Matrix3d& matrix)
{
  Json rows = Json::array ();
  for (int n = 0; n < 3; ++n)
    rows.push_back (toJson (Eigen::Vector3d (matrix.row (n))));
  return rows;
}

std::string
jsonText (const Json& json, int indent)
{
  return json.dump (indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

void
addSceneJson (const PhysicalScene& scene, SceneFolder& folder)
{
  Json frame = poseJson (scene.T_result_scene);
  frame["meaning"] = "p_result = rotation * p_scene + position";
  Json json = {{"name", scene.name},
               {"units", "metres, kilograms, seconds"},
               {"gravity", toJson (scene.gravity)},
               {"T_result_scene", std::move (frame)},
               {"bodies", Json::array ()},
               {"planes", Json::array ()},
               {"contact_tolerance_m", scene.contact_tolerance_m},
               {"warnings", scene.warnings}};
  for (const PhysicalBody& body : scene.bodies)
    json["bodies"].push_back (bodyJson (body, scene, folder));
  for (const PhysicalPlane& plane : scene.planes)
    json["planes"].push_back ({{"name", plane.name},
                               {"urdf", urdfOf (plane.name, folder)},
                               {"T_scene_plane", poseJson (plane.T_scene_plane)},
                               {"size_m", toJson (boxSize (plane))},
                               {"endless", plane.endless}});
  folder.write ("scene.json", jsonText (json, 1));
}

std::vector<std::string>
writeSceneJson (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  addSceneJson (scene, files);
  return files.finish ();
}

} // namespace pcl::cosection
