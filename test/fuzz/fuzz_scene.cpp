// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as the description of a scene.

#include "fuzz_target.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

using namespace pcl::cosection;

namespace {

const char* const
    camera = R"("camera": {"width": 8, "height": 6, "keys": [{"position": [0, -1, 0.5], "look_at": [0, 0, 0]}]})";

void
check (const SimulatedScene& scene)
{
  const std::string spec = effectiveSpec (scene);
  fuzz::require (parseSceneSpec (spec, "again").spec == spec, "a description can be read again, and stays what it is");
  for (const int frame : {0, scene.frames - 1})
  {
    fuzz::require (scene.camera_motion.at (scene.timeOf (frame)).matrix ().allFinite (), "the camera is somewhere");
    for (const SceneBody& body : scene.bodies)
      fuzz::require (body.motion.at (scene.timeOf (frame)).linear ().isUnitary (1e-6), "rotations are rotations");
  }
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  std::vector<std::string> seeds{
      std::string ("{\"frames\": 3, \"rate\": 2.5, ") + camera +
          R"(, "objects": [{"name": "a", "shape": {"type": "sphere", "radius": 0.1}, "keys": [{"position": [0, 0,
            0.1]}, {"time": 1, "position": [1, 0, 0], "rpy_deg": [0, 10, 170]}]}]})",
      std::string ("{") + camera +
          R"(, "depth": {"format": "exr", "noise": {"dropout": 0.1, "range": [0.2, 3]}},
            "background": {"parts": [{"type": "room", "size": [4, 4, 3]}]}, "objects": [{"id": 3, "colour": [1, 2,
            3], "parts": [{"type": "box", "size": [1, 1, 1], "rounding": 0.1}, {"type": "cone", "bottom_radius": 0,
            "top_radius": 1, "height": 1, "quaternion": [0, 0, 0, 1]}], "keys": [{"position": [0, 0, 0]}]}]})",
      std::string ("// a comment\n{") + camera +
          R"(, "views": {"every": 2}, "seed": 7, "objects": [{"shape": {"type": "revolution", "profile": [[0, 0],
            [1, 0], [1, 1], [0, 1]]}, "keys": [{"position": [0, 0, 0]}]}, {"shape": {"type": "extrusion",
            "outline": [[0, 0], [1, 0], [0, 1]], "height": 1}, "keys": [{"position": [0, 0, 5]}]},
            {"shape": {"type": "torus", "radius": 1, "tube_radius": 0.5}, "keys": [{"position": [0, 0, 9]}]}]})"};
  return seeds;
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"\"time\"",
          "\"position\"",
          "\"look_at\"",
          "\"up\"",
          "\"rpy_deg\"",
          "\"quaternion\"",
          "\"frames\"",
          "\"type\"",
          "\"plane\"",
          "\"capsule\"",
          "\"cylinder\"",
          "\"name\"",
          "[",
          "]",
          "{",
          "}",
          ",",
          ":",
          "null",
          "true",
          "false",
          "1e308",
          "-1e308",
          "1e-320",
          "-0.0",
          "0",
          "\"\\u0000\"",
          "\"mesh\"",
          "\"file\": \"/dev/null\"",
          "//"};
}

bool
fuzz::accepts (const std::string& input)
{
  try
  {
    const SimulatedScene scene = parseSceneSpec (input, "scene");
    check (scene);
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  return (true);
}
