// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_folder.h"
#include "scene_geometry.h"
#include "scene_json.h"
#include "scene_writers.h"

namespace pcl::cosection {
namespace {

using Json = nlohmann::ordered_json;

Json
pointJson (const Eigen::Vector3d& p)
{
  return {{"x", p.x ()}, {"y", p.y ()}, {"z", p.z ()}};
}

Json
poseJson (const Eigen::Isometry3d& pose)
{
  const Eigen::Quaterniond q = rotationOf (pose);
  return {{"position", pointJson (pose.translation ())},
          {"orientation", {{"x", q.x ()}, {"y", q.y ()}, {"z", q.z ()}, {"w", q.w ()}}}};
}

/** \brief shape_msgs/Mesh */
Json
meshJson (const TriangleMesh& mesh)
{
  Json triangles = Json::array (), vertices = Json::array ();
  for (const auto& triangle : mesh.triangles)
    triangles.push_back ({{"vertex_indices", triangle}});
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    vertices.push_back (pointJson (vertex.cast<double> ()));
  return {{"triangles", std::move (triangles)}, {"vertices", std::move (vertices)}};
}

/** \brief moveit_msgs/CollisionObject without shapes. */
Json
collisionObject (const std::string& id, const std::string& kind, const Eigen::Isometry3d& pose,
                 const std::string& frame)
{
  constexpr int add = 0; // operation ADD
  Json object = {{"header", {{"stamp", {{"sec", 0}, {"nanosec", 0}}}, {"frame_id", frame}}},
                 {"pose", poseJson (pose)},
                 {"id", id},
                 {"type", {{"key", kind}, {"db", ""}}}};
  for (const char* shapes : {"primitives", "primitive_poses", "meshes", "mesh_poses", "planes", "plane_poses",
                             "subframe_names", "subframe_poses"})
    object[shapes] = Json::array ();
  object["operation"] = add;
  return object;
}

Json
bodyJson (const PhysicalBody& body, const std::string& frame)
{
  Json object = collisionObject (body.name, body.isStatic () ? "static" : "object", body.T_scene_body, frame);
  for (const TriangleMesh& part : body.parts)
  {
    object["meshes"].push_back (meshJson (part));
    object["mesh_poses"].push_back (poseJson (Eigen::Isometry3d::Identity ()));
  }
  return object;
}

Json
planeJson (const PhysicalPlane& plane, const std::string& frame)
{
  constexpr int box = 1; // of shape_msgs/SolidPrimitive
  Json object = collisionObject (plane.name, "plane", plane.T_scene_plane, frame);
  object["primitives"].push_back ({{"type", box}, {"dimensions", toJson (boxSize (plane))}});
  object["primitive_poses"].push_back (poseJson (Eigen::Isometry3d (Eigen::Translation3d (boxCentre (plane)))));
  return object;
}

} // namespace

std::vector<std::string>
writePlanningScene (const PhysicalScene& scene, const std::string& folder)
{
  Json objects = Json::array ();
  for (const PhysicalPlane& plane : scene.planes)
    objects.push_back (planeJson (plane, scene.name));
  for (const PhysicalBody& body : scene.bodies)
    if (!body.parts.empty ()) // a collision object must have a shape
      objects.push_back (bodyJson (body, scene.name));
  // A difference: it adds to what a planner knows already.
  const Json message = {{"name", scene.name},
                        {"robot_state", {{"is_diff", true}}},
                        {"is_diff", true},
                        {"world", {{"collision_objects", std::move (objects)}}}};
  SceneFolder files (folder);
  addSceneJson (scene, files);
  files.write ("planning_scene.json", jsonText (message, -1));
  return files.finish ();
}

} // namespace pcl::cosection
