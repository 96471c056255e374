// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with unusual scenes: what a camera sees that is hardly higher than the things, their tops at grazing
// angles, with half of the readings missing; and things that are tiny or huge, which have the same shapes.

#include "any_cloud_fixture.h"
#include "common/temporary_folder.h"
#include "mesh_measures.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <algorithm>
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

namespace {

/** \brief Mean distance of the vertices of a mesh, divided by its scale, to the reference and back. */
double
meanDistanceOfScaled (TriangleMesh mesh, double scale, const TriangleMesh& reference)
{
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (vertex.cast<double> () / scale).cast<float> ();
  double sum = 0.0;
  const auto add = [&sum] (const TriangleMesh& from, const TriangleMesh& to) {
    const test::ExactMeshDistance distance (to);
    for (const Eigen::Vector3f& vertex : from.vertices)
      sum += distance (vertex.cast<double> ());
  };
  add (mesh, reference);
  add (reference, mesh);
  return sum / static_cast<double> (mesh.vertices.size () + reference.vertices.size ());
}

} // namespace

TEST_F (AnyCloud, ShapesDoNotDependOnTheScale)
{
  const nlohmann::json ball = {{"position", {-0.09, 0.02, 0.0505}}}, box = {{"position", {0.09, 0.0, 0.0505}}};
  const nlohmann::json camera = {
      {"width", 320},
      {"height", 240},
      {"keys", {{{"time", 0}, {"position", {0.1, -0.6, 0.5}}, {"look_at", {0.0, 0.0, 0.05}}}}}};
  std::ofstream (path ("scene.json")) << nlohmann::json{
      {"frames", 1},
      {"rate", 1},
      {"camera", camera},
      {"views", {{"every", 1}}},
      {"background", {{"parts", {{{"type", "plane"}, {"extent", 3}}}}}},
      {"objects",
       {{{"name", "ball"}, {"shape", {{"type", "sphere"}, {"radius", 0.05}}}, {"keys", {ball}}},
        {{"name", "box"}, {"shape", {{"type", "box"}, {"size", {0.12, 0.08, 0.1}}}}, {"keys", {box}}}}}};
  ToolRun simulate ({"scene.json", "sim"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (simulate.wait (), 0) << simulate.errors ();
  ASSERT_EQ (run ({"--quiet", "sim/views/View0000.pcd", "1"}), 0) << errors_;
  for (const std::string scale : {"0.001", "0.03", "1000"})
  {
    ASSERT_EQ (run ({"--quiet", "--scale", scale, "sim/views/View0000.pcd", scale}), 0) << errors_;
    for (const std::string object : {"/object_1.ply", "/object_2.ply"})
    {
      const double s = std::stod (scale), whole = volume ("1" + object);
      EXPECT_NEAR (volume (scale + object) / std::pow (s, 3), whole, 0.005 * whole) << scale << object;
      EXPECT_LE (meanDistanceOfScaled (loadMesh (path (scale + object)), s, loadMesh (path ("1" + object))), 1e-4)
          << scale << object; // a thousandth of their length
    }
  }
}
