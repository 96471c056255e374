// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with clouds that are no labelled views, with given surroundings, and with its further outputs.

#include "any_cloud_fixture.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>

namespace fs = std::filesystem;
using namespace pcl::cosection;

TEST_F (AnyCloud, WholeBodiesHaveTheirMassProperties)
{
  const Eigen::Array3d half (0.1, 0.07, 0.05); // of the box
  pcl::PointCloud<pcl::PointNormal> box;
  constexpr int steps = 60;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side <= 1; side += 2)
      for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j)
        {
          Eigen::Array3d at;
          at[axis] = side;
          at[(axis + 1) % 3] = (2.0 * i + 1.0) / steps - 1.0;
          at[(axis + 2) % 3] = (2.0 * j + 1.0) / steps - 1.0;
          pcl::PointNormal p;
          p.getVector3fMap () = (at * half).matrix ().cast<float> () + Eigen::Vector3f (0.0f, 0.0f, 0.5f);
          p.getNormalVector3fMap () = static_cast<float> (side) * Eigen::Vector3f::Unit (axis);
          box.push_back (p);
        }
  pcl::io::savePCDFileBinary (path ("box.pcd"), box);
  writeSphere (path ("ball.pcd"), 20000);
  const double box_m3 = 8.0 * half.prod ();
  const Eigen::Array3d squares = half.square ();
  const std::tuple<std::string, double, Eigen::Array3d> bodies[] = {
      {"ball", ball_m3, Eigen::Array3d::Constant (0.4 * ball_m3 * 0.01)},
      {"box", box_m3, box_m3 / 3.0 * (squares.sum () - squares)}};
  for (const auto& [name, volume_m3, moments] : bodies)
  {
    ASSERT_EQ (run ({"--json", "s.json", name + ".pcd", name + ".stl"}), 0) << errors_;
    EXPECT_NEAR (volume (name + ".stl"), volume_m3, 0.01 * volume_m3);
    const nlohmann::json object = summary ()["objects"][0];
    EXPECT_NEAR (object["volume_m3"].get<double> (), volume_m3, 0.01 * volume_m3);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        EXPECT_NEAR (object["inertia"][a][b].get<double> (), a == b ? moments[a] : 0.0, 0.01 * moments[a]) << name;
    EXPECT_NEAR (object["centroid_m"][2].get<double> (), 0.5, 0.001);
  }
}

TEST_F (AnyCloud, TrajectoryPutsAMovedObjectTogether)
{
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity ();
  T.rotate (Eigen::AngleAxisf (M_PI / 2.0f, Eigen::Vector3f::UnitX ()));
  T.pretranslate (Eigen::Vector3f (0.3f, 0.2f, 0.1f));
  writeHalf ("a.pcd", 0, Eigen::Isometry3f::Identity ());
  writeHalf ("b.pcd", 1, T);
  write ("poses.txt", "# view tx ty tz qx qy qz qw\n0 0 0 0 0 0 0 1\n1 0.3 0.2 0.1 0.70710678 0 0 0.70710678\n");
  ASSERT_EQ (run ({"--object-trajectory", "1=poses.txt", "--json", "s.json", "a.pcd", "b.pcd", "out.ply"}), 0)
      << errors_;
  EXPECT_NEAR (volume ("out.ply"), ball_m3, 0.02 * ball_m3); // in the object's frame
  EXPECT_NEAR (summary ()["objects"][0]["centroid_m"][2].get<double> (), 0.5, 0.002);

  ASSERT_EQ (run ({"a.pcd", "b.pcd", "two.ply"}), 0) << errors_; // unmoved, they are two balls
  EXPECT_GT (volume ("two.ply"), 1.5 * ball_m3);

  write ("gap.txt", "0 0 0 0 0 0 0 1\n");
  ASSERT_EQ (run ({"--object-trajectory", "1=gap.txt", "a.pcd", "b.pcd", "gap.ply"}), 0) << errors_;
  EXPECT_NE (errors_.find ("b.pcd: its points of label 1 are left out"), std::string::npos) << errors_;
  EXPECT_NEAR (volume ("gap.ply"), ball_m3, 0.05 * ball_m3);
}

TEST_F (AnyCloud, LongThingsAreWarnedOf)
{
  writeSphere (path ("ball.pcd"), 1000);
  ASSERT_EQ (run ({"--scale", "30", "ball.pcd", "out.ply"}), 0) << errors_;
  EXPECT_NE (errors_.find ("object 1 is 5"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("--scale 0.01 for centimetres"), std::string::npos) << errors_;
}

TEST_F (AnyCloud, WrongTrajectoriesAreNamed)
{
  writeHalf ("a.pcd", 0, Eigen::Isometry3f::Identity ());
  write ("late.txt", "7 0 0 0 0 0 0 1\n");
  write ("broken.txt", "0 0 0 0 0 0 1\n");
  write ("good.txt", "0 0 0 0 0 0 0 1\n");
  const auto fails = [this] (const std::string& value, int status, const std::string& part) {
    EXPECT_EQ (run ({"--object-trajectory", value, "a.pcd", "out.ply"}), status) << value;
    EXPECT_NE (errors_.find (part), std::string::npos) << errors_;
    EXPECT_FALSE (fs::exists (path ("out.ply")));
  };
  fails ("1=late.txt", 1, "late.txt: has no pose for any of the 1 views");
  fails ("1=broken.txt", 1, "broken.txt: line 1");
  fails ("1=missing.txt", 1, "missing.txt");
  fails ("good.txt", 2, "ID=FILE");
  fails ("0=good.txt", 2, "ID=FILE");
  fails ("1.5=good.txt", 2, "ID=FILE");
  fails ("1=", 2, "ID=FILE");
  fails ("65535=good.txt", 2, "label 65535 marks what is no object");
  EXPECT_EQ (run ({"--object-trajectory", "5=good.txt", "a.pcd", "out.ply"}), 0);
  EXPECT_NE (errors_.find ("good.txt: is not used, there is no object 5"), std::string::npos) << errors_;
}

TEST_F (AnyCloud, ObstaclesOfAnyFormatKeepObjectsOut)
{
  writeSphere (path ("ball.pcd"), 4000);                                   // at z = 0.5
  const std::string quad = "1 1 0.45\n-1 1 0.45\n-1 -1 0.45\n1 -1 0.45\n"; // crosses it; free above
  write ("table.off", "OFF\n4 1 0\n" + quad + "4 0 1 2 3\n");
  std::string obj;
  std::istringstream lines (quad);
  for (std::string line; std::getline (lines, line);)
    obj += "v " + line + "\n";
  write ("table.obj", obj + "f 1 2 3 4\n");
  ASSERT_EQ (run ({"ball.pcd", "free.ply"}), 0) << errors_;
  for (const char* table : {"table.off", "table.obj"})
  {
    ASSERT_EQ (run ({"--obstacle", table, "--json", "s.json", "ball.pcd", "out.ply"}), 0) << errors_;
    EXPECT_EQ (summary ()["parameters"]["obstacles"][0], table);
    EXPECT_LT (volume ("out.ply"), 0.98 * volume ("free.ply"));
  }
  EXPECT_EQ (run ({"--obstacle", "none.ply", "ball.pcd", "no.ply"}), 1);
  EXPECT_NE (errors_.find ("none.ply"), std::string::npos);
  write ("empty.obj", "# nothing\n");
  EXPECT_EQ (run ({"--obstacle", "empty.obj", "ball.pcd", "no.ply"}), 1);
  EXPECT_NE (errors_.find ("empty.obj"), std::string::npos);
  EXPECT_FALSE (fs::exists (path ("no.ply")));
}

TEST_F (AnyCloud, PointsThatTheMeshLosesAreToldOf)
{
  writeSphere (path ("ball.pcd"), 4000); // 0.1 about z = 0.5
  const auto runOnBlock = [&] (const std::string& top) {
    std::string corners;
    for (const std::string& z : {std::string ("0.3"), top})
      for (const std::string xy : {"-1 -1 ", "1 -1 ", "-1 1 ", "1 1 "})
        corners += xy + z + "\n";
    write ("block.off",
           "OFF\n8 6 0\n" + corners + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
    return run ({"--obstacle", "block.off", "ball.pcd", "out.ply"});
  };
  EXPECT_EQ (runOnBlock ("0.42"), 0);
  EXPECT_EQ (errors_.find ("its mesh shows only"), std::string::npos) << errors_;
  EXPECT_EQ (runOnBlock ("0.48"), 0);
  EXPECT_NE (errors_.find ("object 1: its mesh shows only 6"), std::string::npos) << errors_;
}

TEST_F (AnyCloud, FewFacesStayClosedInEveryFormat)
{
  writeTableScene (path ("scene.pcd"));
  for (const std::string format : {"ply", "stl", "obj"})
  {
    ASSERT_EQ (
        run ({"--resolution", "32", "--max-faces", "500", "--format", format, "--json", "s.json", "scene.pcd", format}),
        0)
        << errors_;
    for (const std::string object : {"/object_1.", "/object_2."})
    {
      const TriangleMesh mesh = loadMesh (path (format + object + format));
      EXPECT_TRUE (computeTopology (mesh).closed_manifold);
      EXPECT_LE (mesh.triangles.size (), 500u);
      EXPECT_GE (mesh.triangles.size (), 480u);
    }
    EXPECT_LE (loadMesh (path (format + "/background." + format)).triangles.size (), 500u);
    EXPECT_EQ (summary ()["objects"][0]["closed"], true);
  }
}

TEST_F (AnyCloud, HullAndBoundsAreWrittenBesideTheMesh)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "32", "--save-hull", "--save-bounds", "scene.pcd", "out"}), 0) << errors_;
  for (const std::string object : {"out/object_1", "out/object_2"})
  {
    EXPECT_LT (volume (object + "_inner.ply"), volume (object + ".ply"));
    EXPECT_GT (volume (object + "_hull.ply"), volume (object + ".ply"));
    EXPECT_GE (volume (object + "_outer.ply"), 0.999 * volume (object + "_hull.ply"));
  }
  writeSphere (path ("ball.pcd"), 4000);
  ASSERT_EQ (run ({"--save-bounds", "ball.pcd", "ball.stl"}), 0) << errors_;
  EXPECT_LT (volume ("ball_inner.stl"), volume ("ball.stl"));
  EXPECT_GE (volume ("ball_outer.stl"), volume ("ball.stl"));
}

TEST_F (AnyCloud, AFailingObjectLosesNoOther)
{
  writeTableScene (path ("scene.pcd"));
  writeSphere (path ("ball.pcd"), 1000);
  pcl::PointCloud<pcl::PointXYZLNormal> ghost; // where the view of the table saw nothing
  pcl::io::loadPCDFile (path ("ball.pcd"), ghost);
  for (auto& p : ghost)
  {
    p.getVector3fMap () = 0.2f * (p.getVector3fMap () - Eigen::Vector3f (0.0f, 0.0f, 0.5f)) +
                          Eigen::Vector3f (0.0f, -0.15f, 0.18f);
    p.label = 3;
  }
  pcl::io::savePCDFileBinary (path ("ghost.pcd"), ghost);
  ASSERT_EQ (run ({"--resolution", "24", "--json", "s.json", "scene.pcd", "ghost.pcd", "out"}), 1) << errors_;
  EXPECT_NE (errors_.find ("object 3: "), std::string::npos) << errors_;
  const nlohmann::json result = summary ();
  ASSERT_EQ (result["failed"].size (), 1u);
  EXPECT_EQ (result["failed"][0]["id"], 3);
  EXPECT_FALSE (result["failed"][0]["error"].get<std::string> ().empty ());
  ASSERT_EQ (result["objects"].size (), 2u);
  EXPECT_GT (volume ("out/object_1.ply"), 0.0);
  EXPECT_GT (volume ("out/object_2.ply"), 0.0);
  EXPECT_FALSE (fs::exists (path ("out/object_3.ply")));
}

TEST_F (AnyCloud, IntensityReachesTheMesh)
{
  writeSphere (path ("ball.pcd"), 4000);
  pcl::PointCloud<pcl::PointXYZINormal> cloud;
  pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
  for (auto& p : cloud)
    p.intensity = p.x > 0.0f ? 10.0f : 2.0f;
  pcl::io::savePCDFileBinary (path ("grey.pcd"), cloud);
  ASSERT_EQ (run ({"grey.pcd", "grey.ply"}), 0) << errors_;
  const TriangleMesh mesh = loadPlyMesh (path ("grey.ply"));
  ASSERT_EQ (mesh.intensity.size (), mesh.vertices.size ());
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (std::abs (mesh.vertices[v].x ()) > 0.02f)
    {
      ASSERT_NEAR (mesh.intensity[v], mesh.vertices[v].x () > 0.0f ? 10.0f : 2.0f, 1e-3f);
    }
}

TEST_F (AnyCloud, PointsCountForTheMemoryAllowed)
{
  writeSphere (path ("ball.pcd"), 200000);
  EXPECT_EQ (run ({"--max-memory", "10M", "ball.pcd", "out.ply"}), 1);
  EXPECT_NE (errors_.find ("ball.pcd: its 200000 points need"), std::string::npos) << errors_;
  EXPECT_EQ (run ({"--max-memory", "5", "ball.pcd", "out.ply"}), 1);
  EXPECT_NE (errors_.find ("; 5 bytes are left"), std::string::npos) << errors_;
  EXPECT_FALSE (fs::exists (path ("out.ply")));
  EXPECT_EQ (run ({"--max-memory", "500M", "ball.pcd", "out.ply"}), 0) << errors_;
}

// A view without its missing readings, as filters leave it: its flying pixels are not to make walls between things.
TEST_F (AnyCloud, UnorganisedViewsAreAsGoodAsOrganisedOnes)
{
  const nlohmann::json at = {{{"position", {0.0, 0.0, 0.0505}}}};
  nlohmann::json keys;
  for (int v = 0; v < 3; ++v)
    keys.push_back ({{"time", v},
                     {"position", {0.8 * std::cos (2.1 * v), 0.8 * std::sin (2.1 * v), 0.5}},
                     {"look_at", {0.0, 0.0, 0.05}}});
  std::ofstream (path ("scene.json")) << nlohmann::json{
      {"frames", 3},
      {"rate", 1},
      {"camera", {{"keys", keys}}},
      {"views", {{"every", 1}}},
      {"background", {{"parts", {{{"type", "plane"}, {"extent", 3}}}}}},
      {"objects", {{{"name", "ball"}, {"shape", {{"type", "sphere"}, {"radius", 0.05}}}, {"keys", at}}}}};
  ToolRun simulate ({"scene.json", "sim"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  ASSERT_EQ (simulate.wait (), 0) << simulate.errors ();
  std::vector<std::string> organised, unorganised;
  for (int v = 0; v < 3; ++v)
  {
    organised.push_back ("sim/views/View000" + std::to_string (v) + ".pcd");
    unorganised.push_back ("u" + std::to_string (v) + ".pcd");
    pcl::PointCloud<pcl::PointXYZL> all, finite;
    pcl::io::loadPCDFile (path (organised.back ()), all);
    finite.sensor_origin_ = all.sensor_origin_;
    finite.sensor_orientation_ = all.sensor_orientation_;
    for (const pcl::PointXYZL& point : all)
      if (std::isfinite (point.z))
        finite.push_back (point);
    pcl::io::savePCDFileBinary (path (unorganised.back ()), finite);
  }
  organised.insert (organised.end (), {"--quiet", "o"});
  unorganised.insert (unorganised.end (), {"--quiet", "u"});
  ASSERT_EQ (run (organised), 0) << errors_;
  ASSERT_EQ (run (unorganised), 0) << errors_;
  const double truth = 4.0 / 3.0 * M_PI * std::pow (0.05, 3);
  EXPECT_NEAR (volume ("o/object_1.ply"), truth, 0.03 * truth);
  EXPECT_NEAR (volume ("u/object_1.ply"), truth, 0.05 * truth);
}

// A reading of intensity may be missing.
TEST_F (AnyCloud, MissingIntensitiesDoNotCount)
{
  writeSphere (path ("ball.pcd"), 3000);
  pcl::PointCloud<pcl::PointNormal> ball;
  pcl::io::loadPCDFile (path ("ball.pcd"), ball);
  pcl::PointCloud<pcl::PointXYZINormal> measured;
  for (std::size_t i = 0; i < ball.size (); ++i)
  {
    pcl::PointXYZINormal p;
    p.getVector3fMap () = ball[i].getVector3fMap ();
    p.getNormalVector3fMap () = ball[i].getNormalVector3fMap ();
    p.intensity = i % 3 == 0 ? std::numeric_limits<float>::quiet_NaN () : 7.5f;
    measured.push_back (p);
  }
  pcl::io::savePCDFileBinary (path ("measured.pcd"), measured);
  ASSERT_EQ (run ({"--quiet", "measured.pcd", "m.ply"}), 0) << errors_;
  const TriangleMesh mesh = loadPlyMesh (path ("m.ply"));
  ASSERT_EQ (mesh.intensity.size (), mesh.vertices.size ());
  for (const float intensity : mesh.intensity)
    ASSERT_FLOAT_EQ (intensity, 7.5f);
}

TEST_F (AnyCloud, LabelsThatBeginAtZeroAreToldOf)
{
  writeSphere (path ("ball.pcd"), 2000);
  pcl::PointCloud<pcl::PointXYZLNormal> ball, both;
  pcl::io::loadPCDFile (path ("ball.pcd"), ball);
  for (std::uint32_t label = 0; label < 2; ++label)
    for (auto p : ball)
    {
      p.x += 0.4f * static_cast<float> (label);
      p.label = label;
      both.push_back (p);
    }
  pcl::io::savePCDFileBinary (path ("two.pcd"), both);
  ASSERT_EQ (run ({"two.pcd", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("extends no farther than object 1: if labels count the objects from 0, add 1"),
             std::string::npos)
      << errors_;
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "24", "scene.pcd", "out"}), 0) << errors_;
  EXPECT_EQ (errors_.find ("count the objects from 0"), std::string::npos) << errors_;
}
