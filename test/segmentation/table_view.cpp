// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_view.h"

#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace pcl::cosection::test {

SceneView
viewOfTable (const std::string& objects, const Eigen::Vector3d& eye)
{
  return viewOfScene (R"({"type": "box", "size": [1.4, 0.9, 0.04], "position": [0, 0.1, -0.02]},
      {"type": "box", "size": [1.4, 0.04, 1.0], "position": [0, 0.57, 0.46]},
      {"type": "plane", "extent": 12, "position": [0, 0, -0.72]})",
                      objects, eye, {0, 0.05, 0.05});
}

SceneView
viewOfScene (const std::string& background, const std::string& objects, const Eigen::Vector3d& eye,
             const Eigen::Vector3d& look_at)
{
  std::ostringstream spec;
  spec << R"({"frames": 1, "camera": {"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5,
    "keys": [{"position": [)"
       << eye.x () << ", " << eye.y () << ", " << eye.z () << R"(], "look_at": [)" << look_at.x () << ", "
       << look_at.y () << ", " << look_at.z () << R"(]}]}, "background": {"parts": [)" << background
       << R"(]}, "objects": [)" << objects << "]}";
  const SimulatedScene scene = parseSceneSpec (spec.str (), "scene");
  const SimulatedFrame frame = SceneRenderer (scene).render (0.0);
  const Image<float> depth = measureDepth (frame.depth, frame.normals, scene.camera, DepthNoise (), 1, 0);
  SceneView view;
  view.width = scene.camera.width;
  view.height = scene.camera.height;
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u)
    {
      const float z = depth.at (u, v);
      view.valid.push_back (std::isfinite (z));
      view.labels.push_back (frame.mask.at (u, v));
      view.points.push_back (std::isfinite (z) ? Eigen::Vector3f (scene.camera.unproject (u, v, z).cast<float> ())
                                               : Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
    }
  return (view);
}

std::string
boxOnTable (int id, const Eigen::Vector3d& size, const Eigen::Vector3d& foot, double yaw_deg)
{
  std::ostringstream text;
  text << (id > 1 ? ", " : "") << R"({"name": "box)" << id << R"(", "id": )" << id
       << R"(, "shape": {"type": "box", "size": [)" << size.x () << ", " << size.y () << ", " << size.z ()
       << R"(]}, "keys": [{"position": [)" << foot.x () << ", " << foot.y () << ", " << foot.z () + 0.5 * size.z ()
       << R"(], "rpy_deg": [0, 0, )" << yaw_deg << "]}]}";
  return (text.str ());
}

} // namespace pcl::cosection::test
