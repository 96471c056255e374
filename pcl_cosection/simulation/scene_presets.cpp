// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

namespace pcl::cosection {
namespace {

const char* const table = R"json({
  "name": "table",
  "description": "five things on a table, seen by a camera that goes half around them",
  "frames": 81,
  "rate": 20,
  "camera": {
    "width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5,
    "keys": [
      {"time": 0, "position": [-0.62, -0.38, 0.48], "look_at": [0, 0, 0.04]},
      {"time": 1, "position": [-0.34, -0.66, 0.50], "look_at": [0, 0, 0.04]},
      {"time": 2, "position": [ 0.00, -0.76, 0.52], "look_at": [0, 0, 0.04]},
      {"time": 3, "position": [ 0.40, -0.62, 0.50], "look_at": [0, 0, 0.04]},
      {"time": 4, "position": [ 0.66, -0.30, 0.46], "look_at": [0, 0, 0.04]}
    ]
  },
  "views": {"every": 20},
  "background": {
    "name": "room",
    "pattern_size": 0.11,
    "parts": [
      {"type": "box", "size": [1.2, 0.9, 0.04], "position": [0, 0.05, -0.02], "colour": [196, 164, 124]},
      {"type": "plane", "extent": 12, "position": [0, 0, -0.72], "colour": [120, 120, 125]}
    ]
  },
  "objects": [
    {
      "name": "mug", "id": 1, "colour": [205, 75, 60], "pattern_size": 0.03,
      "parts": [
        {"type": "revolution", "profile": [[0, 0], [0.040, 0], [0.040, 0.098], [0.038, 0.1], [0.035, 0.1], [0.034,
          0.098],
                                           [0.034, 0.008], [0, 0.006]]},
        {"type": "capsule", "radius": 0.005, "length": 0.026, "position": [0.038, 0, 0.078], "rpy_deg": [0, 90, 0]},
        {"type": "capsule", "radius": 0.005, "length": 0.05, "position": [0.064, 0, 0.028]},
        {"type": "capsule", "radius": 0.005, "length": 0.026, "position": [0.038, 0, 0.028], "rpy_deg": [0, 90, 0]}
      ],
      "keys": [{"position": [-0.17, -0.02, 0], "rpy_deg": [0, 0, -130]}]
    },
    {
      "name": "carton", "id": 2, "colour": [60, 120, 190], "pattern_size": 0.05,
      "shape": {"type": "box", "size": [0.15, 0.07, 0.2], "rounding": 0.002, "position": [0, 0, 0.1]},
      "keys": [{"position": [0.02, 0.14, 0], "rpy_deg": [0, 0, 20]}]
    },
    {
      "name": "ball", "id": 3, "colour": [215, 170, 60], "pattern_size": 0.04,
      "shape": {"type": "sphere", "radius": 0.05},
      "keys": [{"position": [0.09, -0.05, 0.05]}]
    },
    {
      "name": "bottle", "id": 4, "colour": [80, 160, 95], "pattern_size": 0.05,
      "shape": {"type": "revolution", "profile": [[0, 0], [0.036, 0], [0.038, 0.002], [0.038, 0.11], [0.0365, 0.121],
                                                  [0.031, 0.133], [0.021, 0.146], [0.016, 0.157], [0.0148, 0.168],
                                                  [0.0148, 0.205], [0, 0.205]]},
      "keys": [{"position": [0.22, 0.08, 0]}]
    },
    {
      "name": "bowl", "id": 5, "colour": [150, 95, 170], "pattern_size": 0.04,
      "shape": {"type": "revolution", "profile": [[0, 0], [0.032, 0], [0.05, 0.012], [0.064, 0.03], [0.072, 0.052],
                                                  [0.0735, 0.06], [0.0685, 0.06], [0.066, 0.052], [0.058, 0.032],
                                                  [0.045, 0.0165], [0.028, 0.007], [0, 0.006]]},
      "keys": [{"position": [-0.06, -0.17, 0]}]
    }
  ]
}
)json";

const char* const toys = R"json({
  "name": "toys",
  "description": "a truck and a car drive on the floor of a room, past a crate",
  "frames": 101,
  "rate": 25,
  "camera": {
    "width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5,
    "keys": [
      {"time": 0, "position": [-0.35, -1.35, 0.85], "look_at": [0.00, 0.05, 0.05]},
      {"time": 2, "position": [ 0.05, -1.42, 0.90], "look_at": [0.03, 0.05, 0.05]},
      {"time": 4, "position": [ 0.45, -1.32, 0.85], "look_at": [0.05, 0.05, 0.05]}
    ]
  },
  "views": {"every": 20},
  "background": {
    "name": "room",
    "pattern_size": 0.23,
    "parts": [
      {"type": "room", "size": [4, 4, 2.6], "position": [0, 0, 1.3], "colour": [190, 185, 175]},
      {"type": "box", "size": [4, 0.02, 0.12], "position": [0, 1.99, 0.06], "colour": [120, 90, 70]},
      {"type": "box", "size": [0.5, 0.4, 0.45], "position": [1.3, 1.2, 0.225], "rpy_deg": [0, 0, 12],
        "colour": [90, 140, 110]}
    ]
  },
  "objects": [
    {
      "name": "truck", "id": 1, "colour": [200, 60, 50], "pattern_size": 0.07,
      "parts": [
        {"type": "box", "size": [0.32, 0.13, 0.05], "rounding": 0.006, "position": [0, 0, 0.075]},
        {"type": "box", "size": [0.09, 0.13, 0.11], "rounding": 0.012, "position": [0.115, 0, 0.145],
          "colour": [220, 90, 60]},
        {"type": "box", "size": [0.19, 0.14, 0.10], "rounding": 0.006, "position": [-0.06, 0, 0.145],
          "colour": [210, 190, 90]},
        {"type": "cylinder", "radius": 0.04, "height": 0.15, "position": [0.1, 0.075, 0.04], "rpy_deg": [90, 0, 0],
          "colour": [60, 60, 60]},
        {"type": "cylinder", "radius": 0.04, "height": 0.15, "position": [-0.1, 0.075, 0.04], "rpy_deg": [90, 0,
          0], "colour": [60, 60, 60]}
      ],
      "keys": [
        {"time": 0.0, "position": [-0.60, 0.30, 0]},
        {"time": 0.6, "position": [-0.60, 0.30, 0]},
        {"time": 2.4, "position": [ 0.05, 0.26, 0], "rpy_deg": [0, 0, -8]},
        {"time": 3.6, "position": [ 0.45, 0.12, 0], "rpy_deg": [0, 0, -28]},
        {"time": 4.0, "position": [ 0.45, 0.12, 0], "rpy_deg": [0, 0, -28]}
      ]
    },
    {
      "name": "car", "id": 2, "colour": [50, 90, 205], "pattern_size": 0.06,
      "parts": [
        {"type": "extrusion", "height": 0.11, "position": [0, 0.055, 0], "rpy_deg": [90, 0, 0],
         "outline": [[-0.12, 0.03], [0.12, 0.03], [0.122, 0.062], [0.075, 0.072], [0.03, 0.115], [-0.06, 0.115],
           [-0.095, 0.076],
                     [-0.122, 0.07]]},
        {"type": "cylinder", "radius": 0.032, "height": 0.125, "position": [0.075, 0.0625, 0.032], "rpy_deg": [90,
          0, 0], "colour": [50, 50, 55]},
        {"type": "cylinder", "radius": 0.032, "height": 0.125, "position": [-0.075, 0.0625, 0.032], "rpy_deg": [90,
          0, 0], "colour": [50, 50, 55]}
      ],
      "keys": [
        {"time": 0.0, "position": [ 0.55, -0.30, 0], "rpy_deg": [0, 0, 170]},
        {"time": 1.2, "position": [ 0.20, -0.24, 0], "rpy_deg": [0, 0, 178]},
        {"time": 2.4, "position": [-0.20, -0.30, 0], "rpy_deg": [0, 0, 210]},
        {"time": 3.2, "position": [-0.38, -0.45, 0], "rpy_deg": [0, 0, 232]},
        {"time": 4.0, "position": [-0.38, -0.45, 0], "rpy_deg": [0, 0, 232]}
      ]
    },
    {
      "name": "crate", "id": 3, "colour": [205, 160, 80], "pattern_size": 0.08,
      "shape": {"type": "box", "size": [0.24, 0.2, 0.18], "rounding": 0.003, "position": [0, 0, 0.09]},
      "keys": [
        {"time": 0.0, "position": [-0.15, 0.62, 0], "rpy_deg": [0, 0, 25]},
        {"time": 1.6, "position": [-0.15, 0.62, 0], "rpy_deg": [0, 0, 25]},
        {"time": 3.0, "position": [-0.45, 0.55, 0], "rpy_deg": [0, 0, 60]},
        {"time": 4.0, "position": [-0.45, 0.55, 0], "rpy_deg": [0, 0, 60]}
      ]
    }
  ]
}
)json";

const char* const stack = R"json({
  "name": "stack",
  "description": "a brick is lifted off a table, turned, and put on a box",
  "frames": 101,
  "rate": 25,
  "camera": {
    "width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5,
    "keys": [
      {"time": 0, "position": [-0.20, -0.72, 0.48], "look_at": [0.00, 0.02, 0.07]},
      {"time": 4, "position": [ 0.28, -0.68, 0.44], "look_at": [0.01, 0.02, 0.07]}
    ]
  },
  "views": {"every": 20},
  "background": {
    "name": "room",
    "pattern_size": 0.11,
    "parts": [
      {"type": "box", "size": [1.4, 0.9, 0.04], "position": [0, 0.1, -0.02], "colour": [176, 184, 150]},
      {"type": "box", "size": [1.4, 0.04, 1.0], "position": [0, 0.57, 0.46], "colour": [190, 190, 200]},
      {"type": "plane", "extent": 12, "position": [0, 0, -0.72], "colour": [120, 120, 125]}
    ]
  },
  "objects": [
    {
      "name": "box", "id": 1, "colour": [60, 120, 190], "pattern_size": 0.05,
      "shape": {"type": "box", "size": [0.16, 0.12, 0.09], "rounding": 0.003, "position": [0, 0, 0.045]},
      "keys": [{"position": [0.10, 0.08, 0], "rpy_deg": [0, 0, 15]}]
    },
    {
      "name": "brick", "id": 2, "colour": [205, 75, 60], "pattern_size": 0.03,
      "shape": {"type": "box", "size": [0.12, 0.06, 0.05], "rounding": 0.004},
      "keys": [
        {"time": 0.0, "position": [-0.16, -0.02, 0.025], "rpy_deg": [0, 0, 40]},
        {"time": 0.6, "position": [-0.16, -0.02, 0.025], "rpy_deg": [0, 0, 40]},
        {"time": 1.5, "position": [-0.13, -0.01, 0.20], "rpy_deg": [35, 20, 20]},
        {"time": 2.4, "position": [0.09, 0.07, 0.20], "rpy_deg": [80, 10, -10]},
        {"time": 3.0, "position": [0.10, 0.08, 0.14], "rpy_deg": [90, 0, -20]},
        {"time": 3.5, "position": [0.10, 0.08, 0.12], "rpy_deg": [90, 0, -20]},
        {"time": 4.0, "position": [0.10, 0.08, 0.12], "rpy_deg": [90, 0, -20]}
      ]
    },
    {
      "name": "can", "id": 3, "colour": [80, 160, 95], "pattern_size": 0.04,
      "shape": {"type": "revolution", "profile": [[0, 0.003], [0.028, 0.003], [0.03, 0], [0.0325, 0.003], [0.033,
        0.006], [0.033, 0.109],
                                                  [0.0325, 0.112], [0.03, 0.115], [0.0285, 0.113], [0.028, 0.111],
                                                    [0, 0.111]]},
      "keys": [{"position": [-0.05, 0.17, 0]}]
    }
  ]
}
)json";

} // namespace

const std::vector<ScenePreset>&
scenePresets ()
{
  static const std::vector<ScenePreset> presets = {
      {"table", "five things on a table, the camera goes half around them", table},
      {"toys", "a truck, a car and a crate move on the floor of a room", toys},
      {"stack", "a brick is lifted, turned and put on a box", stack},
  };
  return presets;
}

} // namespace pcl::cosection
