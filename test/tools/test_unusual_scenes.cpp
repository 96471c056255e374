// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with unusual scenes: what a camera sees that is hardly higher than the things, their tops at grazing
// angles, with half of the readings missing; things that are tiny or huge, which have the same shapes; and inputs that
// are not what the program would take them for, which it finds out or says.

#include "any_cloud_fixture.h"
#include "common/temporary_folder.h"
#include "mesh_measures.h"
#include "pcl_cosection/view/look_at.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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

namespace {

using OrientedCloud = pcl::PointCloud<pcl::PointNormal>;

class MistakenInput : public AnyCloud
{
protected:
  /** \brief The ball of writeSphere () with its points changed. */
  void saveChanged (const std::string& name, const std::function<void (pcl::PointNormal&)>& change) const
  {
    writeSphere (path ("ball.pcd"), 4000);
    OrientedCloud cloud;
    pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
    for (pcl::PointNormal& p : cloud)
      change (p);
    pcl::io::savePCDFileBinary (path (name), cloud);
  }

  /** \brief Points with labels, ascii. */
  void saveLabelled (const std::string& name, const std::vector<std::pair<Eigen::Vector3f, std::string>>& points) const
  {
    std::ostringstream file;
    file << "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " << points.size ()
         << "\nHEIGHT 1\nPOINTS " << points.size () << "\nDATA ascii\n";
    for (const auto& [p, label] : points)
      file << p.transpose () << ' ' << label << '\n';
    write (name, file.str ());
  }

  std::vector<Eigen::Vector3f> ball () const
  {
    writeSphere (path ("ball.pcd"), 1000);
    OrientedCloud cloud;
    pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
    std::vector<Eigen::Vector3f> points;
    for (const pcl::PointNormal& p : cloud)
      points.emplace_back (p.getVector3fMap ());
    return points;
  }

  bool isSaid (const std::string& part) const { return errors_.find (part) != std::string::npos; }
};

} // namespace

TEST_F (MistakenInput, NormalsThatAreNotOfThePointsAreEstimatedAgain)
{
  const std::string warning = "not those of the surface";
  saveChanged ("right.pcd", [] (pcl::PointNormal&) {});
  ASSERT_EQ (run ({"right.pcd", "right.ply"}), 0) << errors_;
  EXPECT_FALSE (isSaid (warning)) << errors_;
  const Eigen::AngleAxisf turn (1.0f, Eigen::Vector3f (1.0f, 2.0f, 3.0f).normalized ());
  saveChanged ("moved.pcd", [&] (pcl::PointNormal& p) { p.getVector3fMap () = turn * p.getVector3fMap (); });
  saveChanged ("placeholder.pcd", [] (pcl::PointNormal& p) { p.getNormalVector3fMap () = Eigen::Vector3f::UnitZ (); });
  for (const std::string name : {"moved", "placeholder"})
  {
    ASSERT_EQ (run ({name + ".pcd", name + ".ply"}), 0) << errors_;
    EXPECT_TRUE (isSaid (warning)) << errors_;
    EXPECT_NEAR (volume (name + ".ply"), ball_m3, 0.03 * ball_m3) << name;
  }
  // Normals that others estimated may differ by a few degrees.
  const Eigen::AngleAxisf little (0.3f, Eigen::Vector3f::UnitY ());
  saveChanged ("other.pcd",
               [&] (pcl::PointNormal& p) { p.getNormalVector3fMap () = little * p.getNormalVector3fMap (); });
  ASSERT_EQ (run ({"other.pcd", "other.ply"}), 0) << errors_;
  EXPECT_FALSE (isSaid (warning)) << errors_;
}

TEST_F (MistakenInput, ClustersThatCountFromZeroAreWarnedOf)
{
  const std::string warning = "add 1 to all";
  for (const char* unlabelled : {"-1", "nan"})
  {
    std::vector<std::pair<Eigen::Vector3f, std::string>> points;
    for (const Eigen::Vector3f& p : ball ())
    {
      points.emplace_back (p, "0");
      points.emplace_back (p + 0.3f * Eigen::Vector3f::UnitX (), "1");
      points.emplace_back (2.0f * p, unlabelled);
    }
    saveLabelled ("clusters.pcd", points);
    ASSERT_EQ (run ({"clusters.pcd", "out"}), 0) << errors_;
    EXPECT_TRUE (isSaid (warning)) << errors_;
    ASSERT_EQ (run ({"--background", "1", "clusters.pcd", "out"}), 0) << errors_; // it is known what 0 is
    EXPECT_FALSE (isSaid (warning)) << errors_;
  }
}

TEST_F (MistakenInput, SkippedLabelsAreSummedUp)
{
  std::vector<std::pair<Eigen::Vector3f, std::string>> points;
  int label = 1;
  for (const Eigen::Vector3f& p : ball ())
    points.emplace_back (p, std::to_string (points.size () < 300 ? 1 : ++label));
  saveLabelled ("many.pcd", points);
  ASSERT_EQ (run ({"many.pcd", "out"}), 0) << errors_;
  EXPECT_TRUE (isSaid ("680 more labels are skipped")) << errors_;
  EXPECT_LT (std::count (errors_.begin (), errors_.end (), '\n'), 30) << errors_;
}

TEST_F (MistakenInput, PlanesFarFromAllObjectsAreWarnedOf)
{
  const std::string warning = "is the sign of D right?";
  writeSphere (path ("ball.pcd"), 4000); // its lowest point has z = 0.4
  for (const auto& [planes, is_far] : std::vector<std::pair<std::vector<std::string>, bool>>{
           {{"--plane", "0,0,1,-0.4"}, false},
           {{"--plane", "0,0,1,0.4"}, true},
           {{"--plane", "0,0,2,-800"}, true},                           // millimetres
           {{"--plane", "0,0,1,0.4", "--plane", "0,0,1,-0.4"}, false}}) // the floor as well
  {
    std::vector<std::string> arguments = planes;
    arguments.insert (arguments.end (), {"ball.pcd", "ball.ply"});
    ASSERT_EQ (run (arguments), 0) << errors_;
    EXPECT_EQ (isSaid (warning), is_far) << planes[1] << '\n' << errors_;
    EXPECT_NEAR (volume ("ball.ply"), ball_m3, 0.03 * ball_m3) << planes[1];
  }
}

TEST_F (MistakenInput, LargeVoxelsAreWarnedOf)
{
  writeSphere (path ("ball.pcd"), 4000);
  for (const auto& [size, is_large] : std::vector<std::pair<std::string, bool>>{{"0.02", false}, {"0.04", true}})
  {
    ASSERT_EQ (run ({"--voxel-size", size, "ball.pcd", "ball.ply"}), 0) << errors_;
    EXPECT_EQ (isSaid ("is large for object 1"), is_large) << errors_;
    EXPECT_EQ (std::abs (volume ("ball.ply") - ball_m3) > 0.1 * ball_m3, is_large) << volume ("ball.ply");
  }
}

TEST_F (MistakenInput, PointsThatTheHeaderDoesNotAnnounceAreWarnedOf)
{
  writeSphere (path ("ball.pcd"), 4000);
  for (const bool binary : {false, true})
  {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
    pcl::io::savePCDFile (path ("long.pcd"), cloud, binary);
    const std::string whole = pcl::cosection::test::readFile (path ("long.pcd"));
    std::string text = whole;
    for (const std::string key : {"WIDTH ", "POINTS "})
      text.replace (text.find (key) + key.size (), 4, "3000");
    pcl::cosection::test::writeFile (path ("long.pcd"), text);
    ASSERT_EQ (run ({"long.pcd", "long.ply"}), 0) << errors_;
    EXPECT_TRUE (isSaid ("holds more points than the 3000 that its header announces")) << errors_;
    pcl::cosection::test::writeFile (path ("long.pcd"), whole + "\n");
    ASSERT_EQ (run ({"long.pcd", "long.ply"}), 0) << errors_;
    EXPECT_FALSE (isSaid ("holds more points")) << errors_;
  }
}

TEST_F (MistakenInput, PointsOfABigEndianMachineAreRefused)
{
  writeSphere (path ("ball.pcd"), 4000);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
  for (pcl::PointXYZ& p : cloud)
    for (float* value : {&p.x, &p.y, &p.z})
      std::reverse (reinterpret_cast<char*> (value), reinterpret_cast<char*> (value) + sizeof (float));
  pcl::io::savePCDFileBinary (path ("big.pcd"), cloud);
  EXPECT_EQ (run ({"big.pcd", "big.ply"}), 1);
  EXPECT_TRUE (isSaid ("big-endian")) << errors_;
}

TEST_F (MistakenInput, AnOrganisedCloudThatIsNoImageIsAsWithoutAnOrder)
{
  // The heights that a scanner above measures of a box of 18 x 20 x 6 cm, which is at no place of the cloud.
  pcl::PointCloud<pcl::PointXYZL> map (140, 140);
  for (int v = 0; v < 140; ++v)
    for (int u = 0; u < 140; ++u)
    {
      pcl::PointXYZL& p = map.at (u, v);
      const bool on_box = std::abs (u - 69.5f) < 45.0f && std::abs (v - 69.5f) < 50.0f;
      p.getVector3fMap () = Eigen::Vector3f (0.002f * static_cast<float> (u - 70), 0.002f * static_cast<float> (v - 70),
                                             on_box ? 0.06f : 0.0f); // zero is no reading to a camera
      p.label = on_box;
    }
  pcl::io::savePCDFileBinary (path ("map.pcd"), map);
  ASSERT_EQ (run ({"--world-points", "map.pcd", "map.ply"}), 0) << errors_;
  EXPECT_TRUE (isSaid ("as if without an order")) << errors_;
  pcl::PointCloud<pcl::PointXYZL> list = map;
  list.width = 140 * 140;
  list.height = 1;
  pcl::io::savePCDFileBinary (path ("list.pcd"), list);
  ASSERT_EQ (run ({"--world-points", "list.pcd", "list.ply"}), 0) << errors_;
  EXPECT_EQ (volume ("map.ply"), volume ("list.ply"));
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : loadMesh (path ("map.ply")).vertices)
    box.extend (vertex);
  EXPECT_NEAR (box.min ().z (), 0.0f, 0.002f); // below the top, not above it
  EXPECT_NEAR (box.max ().z (), 0.06f, 0.002f);
}

TEST_F (AnyCloud, ASheetThatIsLostIsWarnedOf)
{
  // A sheet of 3 mm, 15 cm high, on a base, seen on its edge: one pixel wide, so that voxels on it are seen free.
  const pcl::cosection::PinholeCamera camera{320, 240, 285.0, 285.0, 159.5, 119.5};
  const Eigen::Isometry3d T = lookAt ({0.001, -0.6, 0.45}, {0.0, 0.0, 0.0});
  const auto hit = [] (const Eigen::Array3d& eye, const Eigen::Array3d& ray, const Eigen::Array3d& low,
                       const Eigen::Array3d& high) {
    const Eigen::Array3d a = (low - eye) / ray, b = (high - eye) / ray;
    const double near = a.min (b).maxCoeff (), far = a.max (b).minCoeff ();
    return near <= far ? near : 1e9;
  };
  for (const double high : {0.15, 0.012})
  {
    pcl::PointCloud<pcl::PointXYZL> cloud (camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        const Eigen::Vector3d ray = camera.unproject (u, v, 1.0), eye = T.translation (), along = T.linear () * ray;
        const double table = along.z () < 0.0 ? -eye.z () / along.z () : 1e9;
        const double thing = std::min (hit (eye, along, {-0.06, -0.05, 0.0}, {0.06, 0.05, 0.012}),
                                       hit (eye, along, {-0.0015, -0.05, 0.0}, {0.0015, 0.05, high}));
        const double z = std::min (table, thing);
        cloud.at (u, v).getVector3fMap () = (ray * (z < 100.0 ? z : std::nan (""))).cast<float> ();
        cloud.at (u, v).label = thing < table ? 1 : 0;
      }
    cloud.is_dense = false;
    cloud.sensor_origin_.head<3> () = T.translation ().cast<float> ();
    cloud.sensor_orientation_ = Eigen::Quaternionf (T.linear ().cast<float> ());
    pcl::io::savePCDFileBinary (path ("sheet.pcd"), cloud);
    ASSERT_EQ (run ({"sheet.pcd", "sheet"}), 0) << errors_;
    double top_m = 0.0;
    for (const Eigen::Vector3f& vertex : loadMesh (path ("sheet/object_1.ply")).vertices)
      top_m = std::max<double> (top_m, vertex.z ());
    EXPECT_EQ (errors_.find ("object 1: its mesh shows only") != std::string::npos, top_m < 0.9 * high) << errors_;
  }
}
