// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with small things and with large ones: a view of which everything is scaled has the same shapes.

#include "any_cloud_fixture.h"
#include "mesh_measures.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace pcl::cosection;

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
