// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tracking_scene.h"

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>

namespace pcl::cosection::test {
namespace {

constexpr double chord_m = 1e-3;
constexpr double volume_margin = 0.125;

Eigen::AlignedBox3d
boxOf (const SceneBody& body)
{
  Eigen::AlignedBox3d box;
  for (const BodyPart& part : body.parts)
    for (const Eigen::Vector3f& v : part.shape->tessellate (chord_m).vertices)
      box.extend (part.T_body_part * v.cast<double> ());
  return box;
}

Eigen::Vector3d
randomDirection (std::mt19937& random)
{
  std::normal_distribution<double> normal;
  const double x = normal (random), y = normal (random), z = normal (random);
  return Eigen::Vector3d (x, y, z).normalized ();
}

} // namespace

std::vector<Eigen::Vector3f>
BodyView::points (const PinholeCamera& camera) const
{
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (std::isfinite (depth.at (u, v)))
        points.push_back (camera.unproject (u, v, depth.at (u, v)).cast<float> ());
  return points;
}

SceneBody
presetBody (const std::string& preset, const std::string& name)
{
  for (const ScenePreset& p : scenePresets ())
    if (p.name == preset)
      for (SceneBody body : parseSceneSpec (p.spec, p.name).bodies)
        if (body.name == name)
        {
          body.id = 1;
          body.motion = KeyedMotion ();
          return body;
        }
  throw InvalidArgument ("no body " + name + " in preset " + preset);
}

std::vector<Eigen::Isometry3d>
posesAroundBody (const Eigen::Vector3d& center, double distance_m, int count, double turn_rad)
{
  std::vector<Eigen::Isometry3d> poses;
  const double golden_angle = M_PI * (3.0 - std::sqrt (5.0));
  for (int n = 0; n < count; ++n)
  {
    const double z = 0.9 - 1.4 * (n + 0.5) / count;
    const double angle = golden_angle * n + turn_rad;
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d direction (r * std::cos (angle), r * std::sin (angle), z);
    poses.push_back (lookAt (center + distance_m * direction, center));
  }
  return poses;
}

Eigen::Isometry3d
poseOnCircle (const Eigen::Vector3d& center, double distance_m, double turn_rad)
{
  const Eigen::Vector3d direction (0.8 * std::cos (turn_rad), 0.8 * std::sin (turn_rad), 0.6);
  return lookAt (center + distance_m * direction, center);
}

std::vector<BodyView>
renderBody (const SceneBody& body, const PinholeCamera& camera, const std::vector<Eigen::Isometry3d>& poses, bool noise)
{
  SceneBody room;
  room.name = "room";
  std::vector<BodyView> views;
  for (const Eigen::Isometry3d& pose : poses)
  {
    SimulatedScene scene;
    scene.camera = camera;
    scene.camera_motion = KeyedMotion (pose);
    scene.bodies = {room, body};
    SimulatedFrame frame = SceneRenderer (scene).render (0.0);
    if (noise)
      frame.depth = measureDepth (frame.depth, frame.normals, camera, DepthNoise (), 1, views.size ());
    views.push_back ({pose, frame.depth});
  }
  return views;
}

VoxelGrid
bodyGrid (const SceneBody& body, int resolution)
{
  const Eigen::AlignedBox3d box = boxOf (body);
  VoxelGrid grid;
  grid.dims.setConstant (resolution);
  grid.voxel_size_m = (1.0 + 2.0 * volume_margin) * box.sizes ().maxCoeff () / resolution;
  grid.origin_m = box.center () - 0.5 * grid.voxel_size_m * (resolution - 1) * Eigen::Vector3d::Ones ();
  return grid;
}

SignedDistanceField
bodyDistance (const SceneBody& body, int resolution)
{
  SignedDistanceField field;
  field.grid = bodyGrid (body, resolution);
  for (int k = 0; k < resolution; ++k)
    for (int j = 0; j < resolution; ++j)
      for (int i = 0; i < resolution; ++i)
        field.values.push_back (static_cast<float> (body.distance (field.grid.center (i, j, k))));
  return field;
}

TsdfVolume
bodyTsdf (const SceneBody& body, const PinholeCamera& camera, const std::vector<BodyView>& views, int resolution,
          const TsdfOptions& options)
{
  TsdfVolume volume (bodyGrid (body, resolution), options);
  for (const BodyView& view : views)
    volume.integrate (view.depth, camera, view.T_body_sensor);
  return volume;
}

Eigen::Vector3d
bodyCenter (const SceneBody& body)
{
  return boxOf (body).center ();
}

Eigen::Isometry3d
randomMotion (std::mt19937& random, const Eigen::Vector3d& center, double max_angle_rad, double max_shift_m)
{
  std::uniform_real_distribution<double> share (0.0, 1.0);
  const Eigen::Vector3d axis = randomDirection (random);
  const Eigen::Vector3d direction = randomDirection (random);
  const double angle = max_angle_rad * share (random);
  const double shift = max_shift_m * share (random);
  return Eigen::Translation3d (center + shift * direction) * Eigen::AngleAxisd (angle, axis) *
         Eigen::Translation3d (-center);
}

} // namespace pcl::cosection::test
