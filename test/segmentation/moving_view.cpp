// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "moving_view.h"

#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <cmath>
#include <sstream>

namespace pcl::cosection::test {

MovingTable::MovingTable (const std::string& objects, const std::string& camera_keys)
{
  std::ostringstream spec;
  spec << R"({"frames": 200, "camera": {"width": 320, "height": 240, "fx": 262, "fy": 262, "cx": 159.5, "cy": 119.5,
        "keys": [)"
       << (camera_keys.empty () ? R"({"position": [-0.3, -0.95, 0.7], "look_at": [0, 0.05, 0.05]})" : camera_keys)
       << R"(]},
    "background": {"parts": [
      {"type": "box", "size": [1.6, 1.0, 0.04], "position": [0, 0.1, -0.02]},
      {"type": "box", "size": [1.6, 0.04, 1.0], "position": [0, 0.62, 0.46]},
      {"type": "plane", "extent": 12, "position": [0, 0, -0.72]}]},
    "objects": [)";
  room_ = parseSceneSpec (spec.str () + "]}", "room");
  spec << objects << "]}";
  scene_ = parseSceneSpec (spec.str (), "table");
  // The noise of a camera of 640 x 480 whose image is reduced.
  DepthNoise noise;
  noise.disparity_sigma_px *= 0.5;
  noise.disparity_step_px *= 0.5;
  noise.lateral_sigma_px *= 0.5;
  scene_.noise = noise;
}

MovingView
MovingTable::at (int n) const
{
  const SimulatedFrame seen = SceneRenderer (scene_).render (scene_.timeOf (n));
  const Image<float> depth = measureDepth (seen.depth, seen.normals, scene_.camera, *scene_.noise, scene_.seed, n);
  MovingView view;
  view.frame.camera = scene_.camera;
  view.frame.T_world_sensor = seen.T_world_camera;
  view.room_depth = SceneRenderer (room_).render (scene_.timeOf (n)).depth.pixels;
  for (int v = 0; v < scene_.camera.height; ++v)
    for (int u = 0; u < scene_.camera.width; ++u)
    {
      const float z = depth.at (u, v);
      view.valid.push_back (std::isfinite (z));
      view.labels.push_back (seen.mask.at (u, v));
      view.frame.points.emplace_back (scene_.camera.unproject (u, v, z).cast<float> ());
    }
  return view;
}

std::string
movingBox (int id, const Eigen::Vector3d& size, const std::string& keys)
{
  std::ostringstream text;
  text << (id > 1 ? ", " : "") << R"({"name": "box)" << id << R"(", "id": )" << id
       << R"(, "shape": {"type": "box", "size": [)" << size.x () << ", " << size.y () << ", " << size.z ()
       << R"(]}, "keys": [)" << keys << "]}";
  return text.str ();
}

} // namespace pcl::cosection::test
