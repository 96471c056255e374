// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with what a camera sees that is hardly higher than the things: their tops at grazing angles, with half of
// the readings missing.

#include "common/temporary_folder.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

using namespace pcl::cosection;

constexpr double true_litres = 7.2;

TEST (LowCameras, BoxesAreNoPlates)
{
  pcl::cosection::test::TemporaryFolder folder;
  for (const double degrees : {8.0, 10.0, 14.0})
  {
    SCOPED_TRACE (std::to_string (degrees) + " degrees");
    const std::string scene = "seen_from_" + std::to_string (degrees);
    std::ofstream (folder.file ("box.json"))
        << R"({"name": "box", "frames": 1, "seed": 3, "views": {"every": 1},
      "camera": {"keys": [{"time": 0, "position": [0, -0.9, )"
        << 0.2 + 0.9 * std::tan (degrees * M_PI / 180.0) << R"(], "look_at": [0, 0, 0.1]}]},
      "objects": [{"name": "box", "id": 1, "parts": [{"type": "box", "size": [0.12, 0.3, 0.2], "position": [0, 0,
        0.1]}],
        "keys": [{"position": [0, 0, 0], "rpy_deg": [0, 0, 15]}]}],
      "background": {"name": "background", "parts": [{"type": "box", "size": [1.4, 1.1, 0.04], "position": [0, 0,
        -0.02]}]}})";
    ToolRun simulate ({"box.json", scene}, folder.file (""), {}, PCL_COSECTION_SIMULATE);
    ASSERT_EQ (simulate.wait (), 0) << simulate.errors ();
    ToolRun tool ({scene + "/views/View0000.pcd", "mesh.ply"}, folder.file (""));
    ASSERT_EQ (tool.wait (), 0) << tool.errors ();
    const TriangleMesh mesh = loadMesh (folder.file ("mesh.ply"));
    EXPECT_TRUE (computeTopology (mesh).closed_manifold);
    const double litres = 1e3 * computeMassProperties (mesh).volume_m3;
    std::printf ("seen from %g degrees above its top: %.2f litres, truly %.2f\n", degrees, litres, true_litres);
    EXPECT_NEAR (litres, true_litres, 0.2 * true_litres);
  }
}
