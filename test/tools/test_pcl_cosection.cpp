// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program as a user runs it; the options themselves are tested in test_command_line.cpp.

#include "scene_files.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <sstream>
#include <thread>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

class PclCosection : public ToolTest
{
protected:
  /** \brief Run to a failure of \a status that says \a part in one line and leaves no output. */
  void expectFailure (const std::vector<std::string>& arguments, int status, const std::string& part)
  {
    SCOPED_TRACE (testing::PrintToString (arguments));
    EXPECT_EQ (run (arguments), status);
    expectOneError (errors_, part);
    EXPECT_FALSE (fs::exists (path ("out")));
    EXPECT_FALSE (fs::exists (path ("out.ply")));
  }

  std::set<std::string> files (const std::string& name) const
  {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator (path (name)))
      names.insert (entry.path ().filename ().string ());
    return (names);
  }
};

std::string
asciiCloud (int count, const std::string& lines, bool labels = false)
{
  const std::string extra = labels ? " label" : "", four = labels ? " 4" : "", type = labels ? " U" : "",
                    one = labels ? " 1" : "";
  return ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z" + extra + "\nSIZE 4 4 4" + four + "\nTYPE F F F" + type +
          "\nCOUNT 1 1 1" + one + "\nWIDTH " + std::to_string (count) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
          std::to_string (count) + "\nDATA ascii\n" + lines);
}

} // namespace

TEST_F (PclCosection, HelpAndVersion)
{
  EXPECT_EQ (run ({"--help"}), 0);
  EXPECT_NE (output_.find ("Examples:"), std::string::npos);
  std::istringstream lines (output_);
  for (std::string line; std::getline (lines, line);)
    EXPECT_LE (line.size (), 100u) << line;
  EXPECT_EQ (run ({"--version"}), 0);
  EXPECT_EQ (output_.rfind ("pcl_cosection ", 0), 0u);
}

TEST_F (PclCosection, LabelledSceneGivesAMeshPerObject)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "32", "--save-sdf", "--json", "s.json", "scene.pcd", "out"}), 0) << errors_;
  EXPECT_EQ (files ("out"), (std::set<std::string>{"background.ply", "object_1.ply", "object_1.vti", "object_2.ply",
                                                   "object_2.vti", "summary.json"}));
  EXPECT_EQ (read ("out/summary.json"), read ("s.json"));
  for (const char* name : {"out/object_1.ply", "out/object_2.ply"})
  {
    const TriangleMesh mesh = loadPlyMesh (path (name));
    EXPECT_TRUE (computeTopology (mesh).closed_manifold);
    EXPECT_EQ (mesh.colours.size (), mesh.vertices.size ());
    EXPECT_EQ (mesh.provenance.size (), mesh.vertices.size ());
    EXPECT_EQ (mesh.confidence.size (), mesh.vertices.size ());
    EXPECT_EQ (mesh.sigma_m.size (), mesh.vertices.size ());
  }
  const MassProperties ball = computeMassProperties (loadPlyMesh (path ("out/object_1.ply")));
  EXPECT_NEAR (ball.volume_m3, 0.0009, 0.0003);
  const TriangleMesh surface = loadPlyMesh (path ("out/object_1.ply"));
  double mean_error = 0.0;
  for (const Eigen::Vector3f& v : surface.vertices)
    mean_error += std::abs ((v.cast<double> () - Eigen::Vector3d (-0.09, 0.0, 0.06)).norm () - 0.06) /
                  static_cast<double> (surface.vertices.size ());
  EXPECT_LT (mean_error, 0.0075);                                                    // two voxels
  EXPECT_LT ((ball.centroid_m - Eigen::Vector3d (-0.09, 0.0, 0.06)).norm (), 0.015); // world frame

  const nlohmann::json summary = json ("s.json");
  const auto keys = [] (const nlohmann::json& object) {
    std::set<std::string> names;
    for (const auto& item : object.items ())
      names.insert (item.key ());
    return (names);
  };
  EXPECT_EQ (keys (summary), (std::set<std::string>{"timings_s", "parameters", "objects", "failed", "support_planes",
                                                    "views", "warnings"}));
  ASSERT_EQ (summary["views"].size (), 1u);
  const nlohmann::json& pose = summary["views"][0]["T_world_sensor"];
  const Eigen::Vector3d place (pose[0][3], pose[1][3], pose[2][3]), sight (pose[0][2], pose[1][2], pose[2][2]);
  EXPECT_LT ((place - Eigen::Vector3d (0.0, -0.4, 0.35)).norm (), 1e-3); // looking at the origin
  EXPECT_LT ((sight + place.normalized ()).norm (), 1e-3);
  EXPECT_EQ (keys (summary["timings_s"]),
             (std::set<std::string>{"read", "data_term", "constraints", "solve", "mesh", "total"}));
  ASSERT_EQ (summary["objects"].size (), 2u);
  const nlohmann::json& object = summary["objects"][0];
  EXPECT_EQ (keys (object),
             (std::set<std::string>{"id", "label", "voxel_size_m", "dimensions", "vertices", "closed", "euler",
                                    "volume_m3", "centroid_m", "inertia", "provenance", "mean_sigma_m", "penetration_m",
                                    "solver", "outlier_points", "contradicted_share"}));
  EXPECT_EQ (keys (object["solver"]), (std::set<std::string>{"iterations", "converged", "energy"}));
  EXPECT_EQ (object["label"], 1);
  EXPECT_EQ (object["closed"], true);
  double shares = 0.0;
  for (const auto& share : object["provenance"])
    shares += share.get<double> ();
  EXPECT_NEAR (shares, 1.0, 1e-9);
}

TEST_F (PclCosection, WhatAnEarlierRunLeftIsRemoved)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "20", "--save-bounds", "scene.pcd", "out"}), 0) << errors_;
  EXPECT_EQ (files ("out").count ("object_2_outer.ply"), 1u);
  for (const char* name : {"out/object_7.ply", "out/object_1_mine.ply", "out/notes.txt"})
    write (name, "");
  ASSERT_EQ (run ({"--resolution", "20", "scene.pcd", "out"}), 0) << errors_;
  EXPECT_EQ (files ("out"), (std::set<std::string>{"background.ply", "notes.txt", "object_1.ply", "object_1_mine.ply",
                                                   "object_2.ply", "summary.json"}));
}

TEST_F (PclCosection, AProposalMayBeFarFromItsOrigin)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "20", "scene.pcd", "out"}), 0) << errors_;
  const TriangleMesh ball = loadPlyMesh (path ("out/object_1.ply"));
  const Eigen::Vector3d far (1000.0, -2000.0, 30.0);
  saveMesh (ball, path ("far.ply"), far);
  ASSERT_EQ (run ({"--resolution", "20", "--proposal", "1=far.ply", "scene.pcd", "again"}), 0) << errors_;
  const nlohmann::json rows = json ("again/summary.json")["objects"][0]["proposal"]["T_object_proposal"];
  const Eigen::Vector3d in_file = ball.vertices[0].cast<double> () + far;
  Eigen::Vector3d moved;
  for (int row = 0; row < 3; ++row)
    moved[row] = rows[row][0].get<double> () * in_file.x () + rows[row][1].get<double> () * in_file.y () +
                 rows[row][2].get<double> () * in_file.z () + rows[row][3].get<double> ();
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : ball.vertices)
    box.extend (vertex);
  EXPECT_LT (box.exteriorDistance (moved.cast<float> ().eval ()), 0.01f) << moved;
  EXPECT_EQ (run ({"--priors", "none", "--proposal", "1=far.ply", "scene.pcd", "none"}), 2);
  EXPECT_NE (errors_.find ("--proposal has no effect"), std::string::npos) << errors_;
}

TEST_F (PclCosection, BallHasItsVolume)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "32", "scene.pcd", "out"}), 0) << errors_;
  EXPECT_NEAR (computeMassProperties (loadPlyMesh (path ("out/object_1.ply"))).volume_m3, 0.0009, 0.0002);
}

TEST_F (PclCosection, SingleFileHoldsAllObjects)
{
  writeTableScene (path ("scene.pcd"));
  ASSERT_EQ (run ({"--resolution", "24", "--quiet", "scene.pcd", "out.ply"}), 0) << errors_;
  EXPECT_EQ (output_ + errors_, "");
  EXPECT_EQ (computeTopology (loadPlyMesh (path ("out.ply"))).components, 2);
}

TEST_F (PclCosection, FilesDoNotDependOnTheThreads)
{
  writeTableScene (path ("scene.pcd"));
  for (const char* threads : {"1", "4"})
  {
    ASSERT_EQ (run ({"--resolution", "24", "--threads", threads, "scene.pcd", std::string (threads) + ".ply"}), 0)
        << errors_;
  }
  EXPECT_EQ (read ("1.ply"), read ("4.ply"));
}

TEST_F (PclCosection, UnorganizedCloudWithNormals)
{
  writeSphere (path ("sphere.pcd"), 5000);
  for (const char* name : {"sphere.ply", "sphere.stl", "sphere.obj"})
  {
    ASSERT_EQ (run ({"--voxel-size", "0.008", "sphere.pcd", name}), 0) << errors_;
    EXPECT_TRUE (fs::exists (path (name)));
  }
  const TriangleMesh mesh = loadPlyMesh (path ("sphere.ply"));
  EXPECT_TRUE (mesh.colours.empty ()); // the input has none
  EXPECT_NEAR (computeMassProperties (mesh).volume_m3, 4.0 / 3.0 * M_PI * 1e-3, 1e-4);
}

TEST_F (PclCosection, BadInputsAreRefused)
{
  writeSphere (path ("sphere.pcd"), 2000);
  write ("text.pcd", "hello\n");
  write ("empty.pcd", asciiCloud (0, ""));
  write ("nan.pcd", asciiCloud (2, "nan nan nan\nnan nan nan\n"));
  write ("one.pcd", asciiCloud (1, "1 2 3\n"));
  write ("truncated.pcd", read ("sphere.pcd").substr (0, 20000));
  expectFailure ({"missing.pcd", "out"}, 1, "missing.pcd: no such file");
  expectFailure ({".", "out"}, 1, "directory");
  expectFailure ({"text.pcd", "out"}, 1, "neither a PCD nor a PLY file");
  expectFailure ({"empty.pcd", "out"}, 1, "no points");
  expectFailure ({"nan.pcd", "out"}, 1, "finite");
  expectFailure ({"one.pcd", "out"}, 1, "at least 100");
  expectFailure ({"truncated.pcd", "out"}, 1, "truncated");
  expectFailure ({"sphere.pcd", "missing.pcd", "out"}, 1, "missing.pcd");
}

TEST_F (PclCosection, OnlyBackgroundIsNoObject)
{
  std::string lines;
  for (int i = 0; i < 200; ++i)
    lines += std::to_string (0.01 * (i % 20)) + " " + std::to_string (0.01 * (i / 20)) + " 1 0\n";
  write ("table.pcd", asciiCloud (200, lines, true));
  expectFailure ({"table.pcd", "out"}, 1, "all points have label 0");
  for (int i = 0; i < 120; ++i)
    lines += std::to_string (0.001 * i) + " 0 0.9 5\n";
  write ("more.pcd", asciiCloud (320, lines, true));
  expectFailure ({"--ignore", "5", "more.pcd", "out"}, 1,
                 "all points but those that --ignore leaves out have label 0, the background");
}

TEST_F (PclCosection, LabelWithoutEnoughPointsIsSkipped)
{
  writeTableScene (path ("scene.pcd"));
  std::string lines;
  for (int i = 0; i < 50; ++i)
    lines += std::to_string (0.001 * (i % 7)) + " " + std::to_string (0.001 * (i / 7)) + " 0.3 9\n";
  write ("few.pcd", asciiCloud (50, lines, true));
  EXPECT_EQ (run ({"--resolution", "20", "--json", "s.json", "scene.pcd", "few.pcd", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("label 9 is skipped: it has 50 valid points"), std::string::npos) << errors_;
  EXPECT_EQ (files ("out").count ("object_9.ply"), 0u);
  const nlohmann::json summary = json ("s.json");
  ASSERT_FALSE (summary["warnings"].empty ());
  EXPECT_NE (summary["warnings"].dump ().find ("label 9"), std::string::npos);
}

TEST_F (PclCosection, SummaryOfARunThatFails)
{
  write ("broken.pcd", "no cloud");
  expectFailure ({"--json", "s.json", "broken.pcd", "out"}, 1, "broken.pcd: is neither a PCD nor a PLY file");
  const nlohmann::json summary = json ("s.json");
  EXPECT_EQ (summary["error"].get<std::string> ().rfind ("broken.pcd: is neither a PCD nor a PLY file", 0), 0u);
  EXPECT_TRUE (summary["objects"].empty ());
  EXPECT_EQ (summary["parameters"]["constraints"], "all");
}

TEST_F (PclCosection, CoplanarPointsDoNotCrash)
{
  std::string lines;
  for (int i = 0; i < 900; ++i)
    lines += std::to_string (0.01 * (i % 30)) + " " + std::to_string (0.01 * (i / 30)) + " 1\n";
  write ("flat.pcd", asciiCloud (900, lines));
  const int status = run ({"--resolution", "24", "flat.pcd", "out.ply"});
  EXPECT_TRUE (status == 0 || status == 1) << status << errors_;
  if (status == 0)
    EXPECT_TRUE (computeTopology (loadPlyMesh (path ("out.ply"))).closed_manifold);
  else
    EXPECT_NE (errors_.find ("pcl_cosection: error: "), std::string::npos);
  EXPECT_EQ (fs::exists (path ("out.ply")), status == 0);
}

TEST_F (PclCosection, AbsurdVolumesAreRefused)
{
  writeSphere (path ("sphere.pcd"), 2000);
  expectFailure ({"--voxel-size", "1e-9", "sphere.pcd", "out.ply"}, 1, "");
  expectFailure ({"--voxel-size", "1000", "sphere.pcd", "out.ply"}, 1, "");
  expectFailure ({"--resolution", "512", "--max-memory", "10M", "sphere.pcd", "out.ply"}, 1, "memory");
}

TEST_F (PclCosection, UnwritableOutputIsFoundBeforeTheWork)
{
  writeSphere (path ("sphere.pcd"), 2000);
  write ("file", "");
  expectFailure ({"sphere.pcd", "nowhere/out.ply"}, 1, "nowhere");
  expectFailure ({"sphere.pcd", "file"}, 1, "is a file");
  expectFailure ({"sphere.pcd", "file/out"}, 1, "file/out");
  expectFailure ({"sphere.pcd", "out", "--json", "nowhere/s.json"}, 1, "nowhere/s.json");
  fs::create_directory (path ("folder.ply"));
  expectFailure ({"sphere.pcd", "folder.ply"}, 1, "it is a folder");
}

TEST_F (PclCosection, WrongUsageHasItsOwnStatus)
{
  writeSphere (path ("sphere.pcd"), 200);
  expectFailure ({"--voxelsize", "1", "sphere.pcd", "out"}, 2, "did you mean --voxel-size?");
  expectFailure ({"--voxel-size", "-0.01", "sphere.pcd", "out"}, 2, "--voxel-size");
  expectFailure ({"--voxel-size", "nan", "sphere.pcd", "out"}, 2, "--voxel-size");
  expectFailure ({"sphere.pcd", "out.pcd"}, 2, "out.pcd");
  write ("c.ini", "resolutoin = 20\n");
  expectFailure ({"--config", "c.ini", "sphere.pcd", "out"}, 2, "did you mean resolution?");
}

TEST_F (PclCosection, InterruptedSolveLeavesNothing)
{
  writeSphere (path ("sphere.pcd"), 5000);
  for (const int signal : {SIGINT, SIGTERM})
  {
    // A solver that never meets its tolerance.
    ToolRun interrupted ({"--verbose", "--resolution", "96", "--solver", "fast-jacobi", "--max-iterations", "10000000",
                          "--tolerance", "1e-30", "sphere.pcd", "out"},
                         path (""));
    ASSERT_TRUE (interrupted.waitForError ("object 1")) << interrupted.errors ();
    std::this_thread::sleep_for (std::chrono::seconds (1)); // the constraints are set up, the solver is at work
    interrupted.send (signal);
    EXPECT_EQ (interrupted.wait (), 130);
    EXPECT_NE (interrupted.errors ().find ("pcl_cosection: error: interrupted, nothing was written\n"),
               std::string::npos)
        << interrupted.errors ();
    EXPECT_FALSE (fs::exists (path ("out")));
  }
}
