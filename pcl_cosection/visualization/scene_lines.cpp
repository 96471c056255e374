// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_lines.h"

#include "scene_legend.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour path_colour = {30, 90, 200};
constexpr TriangleMesh::Colour frustum_colour = {20, 40, 110};
constexpr double longest_frustum_m = 0.5;
constexpr double frustum_share = 0.25; ///< of the distance from the camera to the nearest object

void
addPath (const RunScene& scene, double stamp, std::vector<SceneLine>& lines)
{
  for (std::size_t n = 1; n < scene.run.camera.size () && scene.run.camera[n].stamp <= stamp; ++n)
    lines.push_back (
        {scene.run.camera[n - 1].pose.translation (), scene.run.camera[n].pose.translation (), path_colour});
}

void
addFrustum (const RunScene& scene, const Eigen::Isometry3d& T_world_camera, std::vector<SceneLine>& lines)
{
  double nearest_m = longest_frustum_m / frustum_share;
  for (const SceneRecord::Object& object : scene.run.objects)
    if (!object.poses.empty ())
    {
      const Eigen::Vector3d middle = object.mesh.vertices.empty () ? Eigen::Vector3d::Zero ().eval ()
                                                                   : vertexBox (object.mesh).center ().eval ();
      nearest_m = std::min (nearest_m, (object.poses.front ().pose * middle - T_world_camera.translation ()).norm ());
    }
  const double depth_m = frustum_share * nearest_m;
  const PinholeCamera camera = scene.camera ();
  const Eigen::Vector3d eye = T_world_camera.translation ();
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [u, v] : {std::pair{-0.5, -0.5},
                             {camera.width - 0.5, -0.5},
                             {camera.width - 0.5, camera.height - 0.5},
                             {-0.5, camera.height - 0.5}})
    corners.push_back (T_world_camera * camera.unproject (u, v, depth_m));
  for (std::size_t n = 0; n < corners.size (); ++n)
  {
    lines.push_back ({eye, corners[n], frustum_colour});
    lines.push_back ({corners[n], corners[(n + 1) % corners.size ()], frustum_colour});
  }
  // What is up in the picture.
  const Eigen::Vector3d middle = 0.5 * (corners[0] + corners[1]);
  const Eigen::Vector3d tip = middle + 0.25 * (corners[0] - corners[3]);
  lines.push_back ({corners[0] + 0.3 * (corners[1] - corners[0]), tip, frustum_colour});
  lines.push_back ({corners[0] + 0.7 * (corners[1] - corners[0]), tip, frustum_colour});
}

void
addBox (const RunScene& scene, const SceneRecord::Object& object, SurfaceMode surface, double stamp,
        std::vector<SceneLine>& lines)
{
  const std::optional<Eigen::Isometry3d> pose = scene.poseAt (object, stamp);
  const TriangleMesh& mesh = scene.surface (object.id,
                                            surface == SurfaceMode::Points ? SurfaceMode::Completed : surface);
  if (!pose || mesh.vertices.empty ())
    return;
  const Eigen::AlignedBox3d box = vertexBox (mesh);
  const auto corner = [&] (int n) { return *pose * box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (n)); };
  for (int n = 0; n < 8; ++n)
    for (int bit : {1, 2, 4})
      if ((n & bit) == 0)
        lines.push_back ({corner (n), corner (n | bit), instanceColour (object.id)});
}

} // namespace

std::vector<SceneLine>
linesOf (const RunScene& scene, double stamp, const SceneView& view)
{
  std::vector<SceneLine> lines;
  const std::optional<Eigen::Isometry3d> camera = scene.cameraAt (stamp);
  if (view.path && view.viewpoint)
    addPath (scene, stamp, lines);
  if (view.frustum && view.viewpoint && camera)
    addFrustum (scene, *camera, lines);
  if (view.boxes)
    for (const SceneRecord::Object& object : scene.run.objects)
      addBox (scene, object, view.surface, stamp, lines);
  return lines;
}

} // namespace pcl::cosection
