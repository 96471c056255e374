// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pcl::cosection::test {

/** \brief A scene as pcl_cosection_simulate reads it: a ball that rolls past a box at rest, and a camera that passes
 * by.
 * \param[in] seconds how long they move
 * \param[in] background the parts of the background */
inline std::string
sceneJson (int frames, int width, int height, double seconds,
           const std::string& background = R"({"type": "plane", "extent": 1})")
{
  const std::string end = std::to_string (seconds);
  return "{\"frames\": " + std::to_string (frames) + ", \"camera\": {\"width\": " + std::to_string (width) +
         ", \"height\": " + std::to_string (height) + R"(, "keys": [
    {"time": 0, "position": [-0.3, -0.7, 0.45], "look_at": [0, 0, 0.05]},
    {"time": )" +
         end + R"(, "position": [0.3, -0.7, 0.5], "look_at": [0, 0, 0.05]}]},
  "background": {"parts": [)" +
         background + R"(]},
  "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "colour": [200, 60, 40],
     "keys": [{"time": 0, "position": [-0.15, 0, 0.1]}, {"time": )" +
         end + R"(, "position": [-0.15, 0.1, 0.1]}]},
    {"name": "box", "shape": {"type": "box", "size": [0.16, 0.12, 0.1]}, "keys": [{"position": [0.12, 0, 0.05]}]}]
})";
}

} // namespace pcl::cosection::test
