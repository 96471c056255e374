// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_lines.h"

#include "pcl_cosection/visualization/scene_colours.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour path_colour = {30, 90, 200};
constexpr TriangleMesh::Colour frustum_colour = {20, 40, 110};
constexpr double longest_frustum_m = 0.5;
constexpr double frustum_share = 0.25; ///< of the way of the camera and its distance to the world's middle
constexpr double near_m = 0.02;
constexpr double most_points = 6000.0; ///< of a line

} // namespace

std::vector<SceneLine>
pathLines (const RunScene& scene, double stamp)
{
  std::vector<SceneLine> lines;
  for (std::size_t n = 1; n < scene.run.camera.size () && scene.run.camera[n].stamp <= stamp; ++n)
    lines.push_back (
        {scene.run.camera[n - 1].pose.translation (), scene.run.camera[n].pose.translation (), path_colour});
  return lines;
}

std::vector<SceneLine>
frustumLines (const RunScene& scene, const Eigen::Isometry3d& T_world_camera)
{
  double nearest_m = longest_frustum_m / frustum_share;
  for (const SceneRecord::Object& object : scene.run.objects)
    if (!object.poses.empty ())
      nearest_m = std::min (nearest_m,
                            (object.poses.front ().pose.translation () - T_world_camera.translation ()).norm ());
  const double depth_m = frustum_share * nearest_m;
  const PinholeCamera camera = scene.camera ();
  const Eigen::Vector3d eye = T_world_camera.translation ();
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [u, v] : {std::pair{-0.5, -0.5},
                             {camera.width - 0.5, -0.5},
                             {camera.width - 0.5, camera.height - 0.5},
                             {-0.5, camera.height - 0.5}})
    corners.push_back (T_world_camera * camera.unproject (u, v, depth_m));
  std::vector<SceneLine> lines;
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
  return lines;
}

std::vector<SceneLine>
boxLines (const RunScene& scene, const SceneRecord::Object& object, SurfaceMode surface, double stamp)
{
  const std::optional<Eigen::Isometry3d> pose = scene.poseAt (object, stamp);
  const TriangleMesh& mesh = scene.surface (object.id,
                                            surface == SurfaceMode::Points ? SurfaceMode::Completed : surface);
  if (!pose || mesh.vertices.empty ())
    return {};
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
  std::vector<SceneLine> lines;
  const auto corner = [&] (int n) { return *pose * box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (n)); };
  for (int n = 0; n < 8; ++n)
    for (int bit : {1, 2, 4})
      if ((n & bit) == 0)
        lines.push_back ({corner (n), corner (n | bit), instanceColour (object.id)});
  return lines;
}

void
samplePoints (const std::vector<SceneLine>& lines, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
              std::vector<Eigen::Vector3f>& points, std::vector<TriangleMesh::Colour>& colours)
{
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse ();
  for (const SceneLine& line : lines)
  {
    Eigen::Vector3d a = T_camera_world * line.begin, b = T_camera_world * line.end;
    if (a.z () > b.z ())
      std::swap (a, b);
    if (b.z () <= near_m)
      continue;
    if (a.z () < near_m)
      a += (near_m - a.z ()) / (b.z () - a.z ()) * (b - a);
    // Equal steps in the picture are steps in the inverse of the depth.
    const double length_px = (camera.project (b) - camera.project (a)).norm ();
    const double steps = std::clamp (std::ceil (length_px), 1.0, most_points);
    for (double n = 0.0; n <= steps; ++n)
    {
      const double share = n / steps;
      const double along = share * a.z () / ((1.0 - share) * b.z () + share * a.z ());
      points.push_back ((T_world_camera * (a + along * (b - a))).cast<float> ());
      colours.push_back (line.colour);
    }
  }
}

} // namespace pcl::cosection
