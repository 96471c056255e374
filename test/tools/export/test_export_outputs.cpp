// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What pcl_cosection_export writes for planners beside rigid bodies: points on objects, and their signed distances.

#include "common/message_of.h"
#include "common/small_meshes.h"
#include "common/temporary_folder.h"
#include "export_command_line.h"
#include "export_scene.h"
#include "tools/tool_run.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

using namespace pcl::cosection;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

constexpr double ball_radius_m = 0.03;
constexpr double voxel_m = 0.004;
const Eigen::Vector3d half_box (0.02, 0.03, 0.05);
const Eigen::Vector3d middle_of_ball (0.2, -0.1, 0.5), middle_of_box (0.0, 0.1, 0.6);

/** \brief A ball with all properties, number 1, and a box without any, number 2, in a frame in which up is neither. */
class ExportOutputs : public testing::Test
{
protected:
  ExportOutputs ()
  {
    fs::create_directory (folder_.file ("result"));
    TriangleMesh ball = test::sphereMesh (ball_radius_m, 24);
    for (Eigen::Vector3f& v : ball.vertices)
    {
      ball.colours.push_back ({200, 100, static_cast<std::uint8_t> (v.z () > 0.0f ? 250 : 0)});
      ball.confidence.push_back (0.5f + 10.0f * v.x ());
      ball.sigma_m.push_back (0.002f);
      ball.provenance.push_back (v.z () > 0.0f ? 0 : 2);
      v += middle_of_ball.cast<float> ();
    }
    saveMesh (ball, folder_.file ("result/object_1.ply"));
    saveMesh (test::boxMesh ((middle_of_box - half_box).cast<float> (), (middle_of_box + half_box).cast<float> ()),
              folder_.file ("result/object_2.ply"));
    writeSummary (voxel_m);
  }

  void writeSummary (double voxel_size_m) const
  {
    json objects = json::array ();
    for (const int id : {1, 2})
      objects.push_back ({{"id", id}, {"voxel_size_m", voxel_size_m}});
    test::writeFile (folder_.file ("result/summary.json"),
                     json ({{"objects", objects}, {"support_planes", {{0.0, -0.8, -0.6, 1.0}}}}).dump ());
  }

  /** \brief Export the result into a folder. */
  ExportReport exportTo (const std::string& output, ExportSettings settings) const
  {
    settings.formats = {"moveit"};
    settings.physics.collision = CollisionShape::Hull;
    return (exportScene (folder_.file ("result"), folder_.file (output), settings));
  }

  json readJson (const std::string& name) const { return (json::parse (test::readFile (folder_.file (name)))); }

  const test::TemporaryFolder folder_;
};

/** \brief An array of a .npy file. */
struct NpyArray
{
  std::vector<float> values;
  std::vector<int> shape;

  float at (int i, int j, int k) const { return (values.at ((i * shape[1] + j) * shape[2] + k)); }
};

NpyArray
readNpy (const std::string& path, const json& description)
{
  const std::string bytes = test::readFile (path);
  const std::size_t header = static_cast<unsigned char> (bytes.at (8)) +
                             256u * static_cast<unsigned char> (bytes.at (9));
  NpyArray array;
  array.shape = description["shape"].get<std::vector<int>> ();
  std::string text;
  for (const int size : array.shape)
    text += std::to_string (size) + ", ";
  EXPECT_NE (bytes.substr (10, header).find ("'shape': (" + text + ")"), std::string::npos);
  array.values.resize ((bytes.size () - 10 - header) / sizeof (float));
  EXPECT_EQ (array.values.size (), static_cast<std::size_t> (array.shape[0]) * array.shape[1] * array.shape[2]);
  std::memcpy (array.values.data (), bytes.data () + 10 + header, array.values.size () * sizeof (float));
  return (array);
}

double
distanceToBox (const Eigen::Vector3d& p)
{
  const Eigen::Vector3d beyond = p.cwiseAbs () - half_box;
  return (beyond.cwiseMax (0.0).norm () + std::min (beyond.maxCoeff (), 0.0));
}

Eigen::Vector3d
vectorOf (const json& list)
{
  return {list.at (0).get<double> (), list.at (1).get<double> (), list.at (2).get<double> ()};
}

/** \brief What the command line is refused for. */
std::string
refusalOf (Words words)
{
  words.insert (words.begin (), {"pcl_cosection_export", "--format", "mjcf", "in", "out"});
  std::vector<const char*> arguments;
  for (const std::string& word : words)
    arguments.push_back (word.c_str ());
  try
  {
    parseExportCommandLine (static_cast<int> (arguments.size ()), arguments.data ());
  }
  catch (const UsageError& error)
  {
    return (error.what ());
  }
  return ("");
}

} // namespace

TEST_F (ExportOutputs, PointsLieOnTheObjectInTheFrameOfTheScene)
{
  ExportSettings settings;
  settings.points = 800;
  const ExportReport report = exportTo ("scene", settings);
  EXPECT_FALSE (report.scene.T_result_scene.linear ().isIdentity (0.1)); // the table is not level in the result

  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud;
  ASSERT_EQ (pcl::io::loadPCDFile (folder_.file ("scene/points/object_1.pcd"), cloud), 0);
  ASSERT_EQ (cloud.size (), 800u);
  for (const pcl::PointXYZRGBNormal& point : cloud)
  {
    const Eigen::Vector3d p = report.scene.T_result_scene * point.getVector3fMap ().cast<double> () - middle_of_ball;
    const Eigen::Vector3d normal = report.scene.T_result_scene.linear () *
                                   point.getNormalVector3fMap ().cast<double> ();
    EXPECT_NEAR (p.norm (), ball_radius_m, 0.0002);
    EXPECT_GT (normal.dot (p.normalized ()), 0.999);
    EXPECT_EQ (point.r, 200);
    if (std::abs (p.z ()) > 0.005)
    {
      EXPECT_EQ (point.b, p.z () > 0.0 ? 250 : 0);
    }
  }
}

TEST_F (ExportOutputs, PointsHaveWhatTheMeshHas)
{
  ExportSettings settings;
  settings.points = 300;
  const ExportReport report = exportTo ("scene", settings);
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ (pcl::io::loadPCDFile (folder_.file ("scene/points/object_1.pcd"), cloud), 0);
  std::string names;
  for (const pcl::PCLPointField& field : cloud.fields)
    names += field.name + " ";
  EXPECT_EQ (names, "x y z normal_x normal_y normal_z rgb confidence sigma_m provenance ");
  EXPECT_EQ (cloud.fields.back ().datatype, pcl::PCLPointField::UINT8);
  const std::string bytes = test::readFile (folder_.file ("scene/points/object_1.pcd"));
  EXPECT_NE (bytes.find ("\nSIZE 4 4 4 4 4 4 4 4 4 1\nTYPE F F F F F F F F F U\n"), std::string::npos);
  EXPECT_NE (bytes.find ("\nDATA binary\n"), std::string::npos);
  for (std::size_t n = 0; n < 300; ++n)
  {
    const std::uint8_t* at = cloud.data.data () + n * cloud.point_step;
    std::array<float, 9> values{};
    std::memcpy (values.data (), at, sizeof (values));
    const Eigen::Vector3d p = report.scene.T_result_scene * Eigen::Vector3d (values[0], values[1], values[2]) -
                              middle_of_ball;
    EXPECT_NEAR (values[7], 0.5 + 10.0 * p.x (), 1e-4);
    EXPECT_NEAR (values[8], 0.002, 1e-6);
    if (std::abs (p.z ()) > 0.005)
    {
      EXPECT_EQ (at[cloud.fields.back ().offset], p.z () > 0.0 ? 0 : 2);
    }
  }
  pcl::PCLPointCloud2 plain;
  ASSERT_EQ (pcl::io::loadPCDFile (folder_.file ("scene/points/object_2.pcd"), plain), 0);
  EXPECT_EQ (plain.fields.size (), 6u);
  EXPECT_EQ (plain.width, 300u);
}

TEST_F (ExportOutputs, DistancesAreExactInAllOfTheBox)
{
  ExportSettings settings;
  settings.save_sdf = true;
  settings.physics.frame = SceneFrame::Result;
  const ExportReport report = exportTo ("scene", settings);
  const json description = readJson ("scene/sdf/object_2.json");
  EXPECT_EQ (description["voxel_size_m"].get<double> (), voxel_m);
  EXPECT_EQ (description["array"], "object_2.npy");
  EXPECT_EQ (description["sign"], "positive outside");
  const Eigen::Vector3d origin = vectorOf (description["origin_m"]);
  const NpyArray array = readNpy (folder_.file ("scene/sdf/object_2.npy"), description);
  EXPECT_LT (array.shape[0], array.shape[1]);
  EXPECT_LT (array.shape[1], array.shape[2]);
  const Eigen::Vector3d centre = report.scene.bodies[1].T_scene_body.inverse () * middle_of_box; // in the body's frame
  EXPECT_LT (centre.norm (), 1e-6);
  for (int i = 0; i < array.shape[0]; ++i)
    for (int j = 0; j < array.shape[1]; ++j)
      for (int k = 0; k < array.shape[2]; ++k)
      {
        const Eigen::Vector3d p = origin + voxel_m * Eigen::Vector3d (i, j, k) - centre;
        ASSERT_NEAR (array.at (i, j, k), distanceToBox (p), 1e-6) << i << " " << j << " " << k;
        const bool border = i * j * k == 0 || i + 1 == array.shape[0] || j + 1 == array.shape[1] ||
                            k + 1 == array.shape[2];
        ASSERT_TRUE (!border || array.at (i, j, k) > 4.999 * voxel_m);
      }
  EXPECT_NE (test::readFile (folder_.file ("scene/sdf/object_2.vti")).find ("signed_distance"), std::string::npos);
}

TEST_F (ExportOutputs, DistancesReachAsFarAsWanted)
{
  ExportSettings settings;
  settings.save_sdf = true;
  settings.sdf_margin_m = 0.05;
  exportTo ("scene", settings);
  const json description = readJson ("scene/sdf/object_1.json");
  const NpyArray array = readNpy (folder_.file ("scene/sdf/object_1.npy"), description);
  const Eigen::Vector3d origin = vectorOf (description["origin_m"]);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_LE (origin[axis], -ball_radius_m - 0.0499);
    EXPECT_GE (origin[axis] + voxel_m * (array.shape[axis] - 1), ball_radius_m + 0.0499);
    EXPECT_LE (voxel_m * (array.shape[axis] - 1), 2.0 * (ball_radius_m + 0.05) + voxel_m);
  }
  EXPECT_NEAR (array.at (0, 0, 0), origin.norm () - ball_radius_m, 0.0002);
}

TEST_F (ExportOutputs, AreReportedAndThereOnlyWhenAskedFor)
{
  EXPECT_EQ (exportTo ("plain", {}).files.size (), 2u);
  EXPECT_FALSE (fs::exists (folder_.file ("plain/points")));
  EXPECT_FALSE (fs::exists (folder_.file ("plain/sdf")));
  ExportSettings settings;
  settings.points = 10;
  settings.save_sdf = true;
  const std::vector<std::string> files = exportTo ("all", settings).files;
  EXPECT_EQ (files.size (), 2u + 2u * 4u);
  for (const std::string& file : files)
    EXPECT_TRUE (fs::is_regular_file (file)) << file;
  EXPECT_NE (std::find (files.begin (), files.end (), folder_.file ("all/points/object_2.pcd")), files.end ());
  EXPECT_NE (std::find (files.begin (), files.end (), folder_.file ("all/sdf/object_1.npy")), files.end ());
}

TEST_F (ExportOutputs, AreTheSameForAnyNumberOfThreads)
{
  ExportSettings settings;
  settings.points = 500;
  settings.save_sdf = true;
  settings.physics.threads = 1;
  exportTo ("one", settings);
  settings.physics.threads = 3;
  exportTo ("three", settings);
  for (const char* file : {"/points/object_1.pcd", "/sdf/object_1.npy", "/sdf/object_2.npy"})
    EXPECT_EQ (test::readFile (folder_.file (std::string ("one") + file)),
               test::readFile (folder_.file (std::string ("three") + file)));
}

TEST_F (ExportOutputs, NeedTheSizeOfVoxels)
{
  ExportSettings settings;
  settings.save_sdf = true;
  writeSummary (0.0);
  EXPECT_NE (test::messageOf<IoError> ([&] { exportTo ("scene", settings); }).find ("object 1 has no voxel_size_m"),
             std::string::npos);
  EXPECT_FALSE (fs::exists (folder_.file ("scene")));
  writeSummary (1e-5); // a field of too many voxels
  EXPECT_NE (test::messageOf<InvalidArgument> ([&] { exportTo ("scene", settings); }).find ("object_1: "),
             std::string::npos);
  EXPECT_FALSE (fs::exists (folder_.file ("scene/sdf")));
}

TEST (ExportOptions, RefuseWhatIsOutOfRange)
{
  EXPECT_EQ (refusalOf ({"--save-points", "1"}), "");
  EXPECT_EQ (refusalOf ({"--save-points", "10000000"}), "");
  for (const char* count : {"0", "-1", "10000001", "1.5", "many", ""})
    EXPECT_NE (refusalOf ({"--save-points", count}).find ("from 1 to 10000000"), std::string::npos) << count;
  EXPECT_EQ (refusalOf ({"--save-sdf", "--sdf-margin", "0.2"}), "");
  EXPECT_EQ (refusalOf ({"--sdf-margin", "0.2"}), "--sdf-margin needs --save-sdf");
  for (const char* margin : {"0", "-1", "11", "nan", "wide"})
    EXPECT_NE (refusalOf ({"--save-sdf", "--sdf-margin", margin}).find ("--sdf-margin"), std::string::npos) << margin;
}

TEST_F (ExportOutputs, AreWrittenByTheProgram)
{
  ToolRun tool ({"--format", "moveit", "--save-points", "100", "--save-sdf", "result", "scene", "--verbose"},
                folder_.file (""), {}, PCL_COSECTION_EXPORT_TOOL);
  EXPECT_EQ (tool.wait (), 0) << tool.errors ();
  EXPECT_NE (tool.errors ().find ("wrote scene/points/object_1.pcd"), std::string::npos) << tool.errors ();
  EXPECT_NE (tool.errors ().find ("wrote scene/sdf/object_2.npy"), std::string::npos) << tool.errors ();
  EXPECT_TRUE (fs::is_regular_file (folder_.file ("scene/points/object_2.pcd")));
}
