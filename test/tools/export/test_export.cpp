// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_export as a user calls it.

#include "common/small_meshes.h"
#include "common/temporary_folder.h"
#include "tools/tool_run.h"

#include <pcl/cosection/io/mesh_io.h>

#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

namespace fs = std::filesystem;

namespace pcl::cosection::test {
namespace {

using Words = std::vector<std::string>;

const char* const plane = "\"support_planes\": [[0, 0, 1, -0.5]]";

/** \brief A result of a box of 10 x 8 x 6 cm that stands on the plane z = 0.5. */
class Export : public testing::Test
{
protected:
  Export ()
  {
    fs::create_directory (folder_.file ("result"));
    save ("result/object_1.ply");
    writeSummary ("{\"objects\": [{\"id\": 1, \"class\": \"box\", \"voxel_size_m\": 0.002}], " + std::string (plane) +
                  "}");
  }

  void save (const std::string& name) const
  {
    saveMesh (boxMesh ({-0.05f, -0.04f, 0.5f}, {0.05f, 0.04f, 0.56f}), folder_.file (name));
  }

  void writeSummary (const std::string& text) const { writeFile (folder_.file ("result/summary.json"), text); }

  /** \brief Run the program in the folder. \return the exit status */
  int run (const Words& arguments)
  {
    ToolRun tool (arguments, folder_.file (""), {}, PCL_COSECTION_EXPORT_TOOL);
    const int status = tool.wait ();
    output_ = tool.output ();
    errors_ = tool.errors ();
    return (status);
  }

  /** \brief It fails with one line, which has \a part, and writes nothing into "out". */
  void expectFailure (int status, const Words& arguments, const std::string& part)
  {
    EXPECT_EQ (run (arguments), status) << part;
    EXPECT_EQ (output_, "") << part;
    EXPECT_EQ (errors_.rfind ("pcl_cosection_export: error: ", 0), 0u) << errors_;
    EXPECT_EQ (std::count (errors_.begin (), errors_.end (), '\n'), 1) << errors_;
    EXPECT_NE (errors_.find (part), std::string::npos) << errors_ << "lacks " << part;
    EXPECT_FALSE (fs::exists (folder_.file ("out/scene.json"))) << part;
    EXPECT_FALSE (fs::exists (folder_.file ("out/meshes"))) << part;
  }

  /** \brief A result of which something is wrong. */
  void expectRefused (const std::string& part) { expectFailure (1, {"--format", "urdf", "result", "out"}, part); }

  nlohmann::json scene () const { return (nlohmann::json::parse (readFile (folder_.file ("out/scene.json")))); }

  const TemporaryFolder folder_;
  std::string output_, errors_;
};

TEST_F (Export, WritesAllFormatsAtOnce)
{
  const Words all = {"--format", "urdf",     "--format", "sdf",      "--format", "mjcf",   "--format",
                     "gltf",     "--format", "usda",     "--format", "moveit",   "result", "deep/out"};
  ASSERT_EQ (run (all), 0) << errors_;
  EXPECT_EQ (errors_, "");
  EXPECT_NE (output_.find ("box_1: 0.24 kg, 1 part of 1 times its volume"), std::string::npos) << output_;
  const std::vector<std::string> files = {
      "scene.json", "box_1.urdf", "support_1.urdf",      "scene.sdf",        "scene.xml",
      "scene.glb",  "scene.usda", "planning_scene.json", "meshes/box_1.obj", "meshes/box_1_part_0.obj"};
  EXPECT_NE (output_.find ("wrote " + std::to_string (files.size ()) + " files into deep/out"), std::string::npos)
      << output_;
  std::size_t found = 0;
  for (const auto& entry : fs::recursive_directory_iterator (folder_.file ("deep/out")))
    found += entry.is_regular_file () ? 1 : 0;
  EXPECT_EQ (found, files.size ());
  for (const std::string& file : files)
    EXPECT_TRUE (fs::exists (folder_.file ("deep/out/" + file))) << file;

  EXPECT_EQ (run (all), 0) << errors_; // over what is there
  Words quiet = all;
  quiet.emplace_back ("--quiet");
  EXPECT_EQ (run (quiet), 0);
  EXPECT_EQ (output_ + errors_, "");
}

TEST_F (Export, UsesMassesDensityAndFrame)
{
  ASSERT_EQ (run ({"--format", "urdf", "result", "out", "--density", "1000"}), 0) << errors_;
  EXPECT_NEAR (scene ()["bodies"][0]["mass_kg"].get<double> (), 0.48, 1e-6);
  EXPECT_EQ (scene ()["bodies"][0]["stands_on"], "support_1");
  EXPECT_NEAR (scene ()["bodies"][0]["T_scene_body"]["position"][2].get<double> (), 0.53, 1e-6);
  ASSERT_EQ (run ({"--format", "urdf", "result", "out", "--density", "1000", "--mass", "1=0.3", "--frame", "table"}), 0)
      << errors_;
  EXPECT_NEAR (scene ()["bodies"][0]["mass_kg"].get<double> (), 0.3, 1e-12);
  EXPECT_NEAR (scene ()["bodies"][0]["T_scene_body"]["position"][2].get<double> (), 0.03, 1e-6);
  EXPECT_NEAR (scene ()["T_result_scene"]["position"][2].get<double> (), 0.5, 1e-9);
}

TEST_F (Export, SaysWhatIsWrongWithTheCommandLine)
{
  const std::vector<std::pair<Words, std::string>> runs = {
      {{"result", "out"}, "--format is missing"},
      {{"--format", "obj", "result", "out"}, "--format"},
      {{"--format", "urdf"}, "RESULT"},
      {{"--format", "urdf", "result"}, "OUTPUT"},
      {{"--format", "urdf", "result", ""}, "OUTPUT"},
      {{"--format", "urdf", "result", "out", "more"}, "more"},
      {{"--format", "urdf", "result", "out", "--density", "0"}, "--density"},
      {{"--format", "urdf", "result", "out", "--density", "-3"}, "--density"},
      {{"--format", "urdf", "result", "out", "--density", "nan"}, "--density"},
      {{"--format", "urdf", "result", "out", "--mass", "nonsense"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1="}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "=1"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1=0"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1=-2"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1.5=2"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1=2", "--mass", "1=3"}, "--mass is given twice for object 1"},
      {{"--format", "urdf", "result", "out", "--mass", "99999999999=2"}, "--mass"},
      {{"--format", "urdf", "result", "out", "--mass", "1=inf"}, "mass"},
      {{"--format", "urdf", "result", "out", "--mass", "7=1"}, "--mass 7: there is no such object in result"},
      {{"--format", "urdf", "result", "out", "--max-parts", "0"}, "--max-parts"},
      {{"--format", "urdf", "result", "out", "--collision", "ball"}, "--collision"},
      {{"--format", "urdf", "result", "out", "--frame", "up"}, "--frame"},
      {{"--format", "urdf", "result", "out", "--densty", "1"}, "--densty"},
      {{"--format", "urdf", "result", "result"}, "result: is RESULT; give another folder"},
      {{"--format", "urdf", "result", "./result/"}, "is RESULT; give another folder"}};
  for (const auto& [arguments, part] : runs)
    expectFailure (2, arguments, part);
}

TEST_F (Export, SaysWhatIsWrongWithTheFolder)
{
  expectFailure (1, {"--format", "urdf", "missing", "out"}, "missing: there is no such folder");
  expectFailure (1, {"--format", "urdf", "result/summary.json", "out"}, "result/summary.json: is a file");
  fs::create_directory (folder_.file ("empty"));
  expectFailure (1, {"--format", "urdf", "empty", "out"}, "empty/summary.json: is missing");
  writeFile (folder_.file ("file"), "");
  expectFailure (1, {"--format", "urdf", "result", "file"}, "file");
  expectFailure (1, {"--format", "urdf", "result", "file/out"}, "file");
  expectFailure (1, {"--format", "urdf", "result", "/proc/out"}, "/proc/out");
  expectFailure (1, {"--format", "urdf", "--collision", "outer", "result", "out"}, "object 1: has no outer bound");
}

TEST_F (Export, SaysWhatIsWrongWithTheSummary)
{
  const std::string summary = "summary.json: ";
  const std::vector<std::pair<std::string, std::string>> texts = {
      {"", summary + "is not JSON"},
      {"no JSON", summary + "is not JSON"},
      {"[1, 2]", summary + "is not JSON"},
      {"{\"objects\": 3}", summary + "is not JSON"},
      {"{}", summary + "is not JSON"},
      {"\xff\xfe\x00", summary + "is not JSON"},
      {std::string (100000, '['), summary + "is not JSON"},
      {"{\"objects\": " + std::string (100000, '[') + std::string (100000, ']') + "}", summary + "is not JSON"},
      {"{\"objects\": []}", summary + "has no objects"},
      {"{\"objects\": [3]}", summary + "an object has no id"},
      {"{\"objects\": [{\"id\": \"1\"}]}", summary + "an object has no id"},
      {"{\"objects\": [{\"id\": -1}]}", summary + "an object has no id"},
      {"{\"objects\": [{\"id\": 1e300}]}", summary + "an object has no id"},
      {"{\"objects\": [{\"id\": 1.5}]}", summary + "an object has no id"},
      {"{\"objects\": [{\"id\": 1}], \"support_planes\": 5}", summary + "support_planes"},
      {"{\"objects\": [{\"id\": 1}], \"origin_m\": [0, 0]}", summary + "origin_m"},
      {"{\"objects\": [{\"id\": 1, \"voxel_size_m\": -1}]}", "object_1.ply: cannot have voxels"},
      {"{\"objects\": [{\"id\": 1, \"voxel_size_m\": 1e-300}]}", "object_1.ply: cannot have voxels"},
      {"{\"objects\": [{\"id\": 1, \"voxel_size_m\": 1e300}]}", "object_1.ply: cannot have voxels"},
      {"{\"objects\": [{\"id\": 1, \"frames_tracked\": 9}]}", "trajectory/object_1.txt: is missing"},
      {"{\"objects\": [{\"id\": 1}], \"support_planes\": [[0, 0, 1]]}", summary + "support_planes"},
      {"{\"objects\": [{\"id\": 1}], \"support_planes\": [[0, 0, 0, 1]]}", summary + "support_planes"},
      {"{\"objects\": [{\"id\": 1}], \"support_planes\": [[0, 0, 1, \"a\"]]}", summary + "support_planes"},
      {"{\"objects\": [{\"id\": 1}], \"error\": \"there is no cloud\"}", "a run that failed: there is no cloud"},
      {"{\"objects\": [{\"id\": 1}], \"error\": \"two\\nlines\"}", "a run that failed: two"},
      {"{\"objects\": [{\"id\": 2}]}", "object_2.ply: is missing"}};
  for (const auto& [text, part] : texts)
  {
    writeSummary (text);
    expectRefused (part);
  }
  fs::remove (folder_.file ("result/summary.json"));
  fs::create_directory (folder_.file ("result/summary.json"));
  expectRefused ("summary.json");
  fs::remove (folder_.file ("result/summary.json"));
  ASSERT_EQ (mkfifo (folder_.file ("result/summary.json").c_str (), 0600), 0);
  expectRefused ("summary.json");
}

TEST_F (Export, SaysWhatIsWrongWithAMesh)
{
  const std::string path = folder_.file ("result/object_1.ply");
  TriangleMesh open = boxMesh ({-0.05f, -0.04f, 0.5f}, {0.05f, 0.04f, 0.56f}), reversed = open;
  open.triangles.pop_back ();
  saveMesh (open, path);
  expectRefused ("object_1.ply: is not a closed surface");
  for (auto& triangle : reversed.triangles)
    std::swap (triangle[0], triangle[1]);
  saveMesh (reversed, path);
  expectRefused ("object 1: its mesh is turned inside out");
  writeFile (path, "no mesh");
  expectRefused ("object_1.ply");
  const std::string whole = [this] {
    save ("whole.ply");
    return (readFile (folder_.file ("whole.ply")));
  }();
  writeFile (path, whole.substr (0, whole.size () / 2));
  expectRefused ("object_1.ply");
  fs::remove (path);
  expectRefused ("object_1.ply: is missing");
}

TEST_F (Export, TwoObjectsMayHaveOneNumber)
{
  writeSummary ("{\"objects\": [{\"id\": 1}, {\"id\": 1}], " + std::string (plane) + "}");
  EXPECT_EQ (run ({"--format", "urdf", "result", "out"}), 0) << errors_;
  EXPECT_EQ (scene ()["bodies"].size (), 2u);
  EXPECT_NE (scene ()["bodies"][0]["name"], scene ()["bodies"][1]["name"]);
}

TEST_F (Export, WarnsOfWhatIsMissing)
{
  writeSummary ("{\"objects\": [{\"id\": 1}], \"failed\": [{\"id\": 2}]}");
  EXPECT_EQ (run ({"--format", "urdf", "result", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("could not be completed"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("there is no support plane"), std::string::npos) << errors_;
  EXPECT_EQ (std::count (errors_.begin (), errors_.end (), '\n'), 2) << errors_;
}

TEST_F (Export, WarnsOfRoundedCoordinates)
{
  saveMesh (boxMesh ({1e5f, 0.0f, 0.5f}, {1e5f + 0.125f, 0.1f, 0.56f}), folder_.file ("result/object_1.ply"));
  EXPECT_EQ (run ({"--format", "urdf", "result", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("object_1.ply: is so far from its origin"), std::string::npos) << errors_;
}

TEST_F (Export, WritesNothingIfASignedDistanceIsTooLarge)
{
  writeSummary ("{\"objects\": [{\"id\": 1, \"voxel_size_m\": 0.0001}], " + std::string (plane) + "}");
  expectFailure (1, {"--format", "urdf", "--save-points", "10", "--save-sdf", "--sdf-margin", "9", "result", "out"},
                 "make the margin smaller");
}

TEST_F (Export, LeavesNothingOnAFullDisk)
{
  ToolRun tool (
      {"--format", "urdf", "result", "out"}, folder_.file (""),
      [] {
        const rlimit limit{300, 300};
        setrlimit (RLIMIT_FSIZE, &limit);
      },
      PCL_COSECTION_EXPORT_TOOL);
  EXPECT_EQ (tool.wait (), 1);
  const std::string errors = tool.errors ();
  EXPECT_EQ (std::count (errors.begin (), errors.end (), '\n'), 1) << errors;
  EXPECT_FALSE (fs::exists (folder_.file ("out")));
}

TEST_F (Export, AFailedRunLeavesAnEarlierExportAsItWas)
{
  const Words arguments = {"--format", "mjcf", "--format", "urdf", "--density", "900", "result", "out"};
  ASSERT_EQ (run ({"--format", "mjcf", "--format", "urdf", "result", "out"}), 0) << errors_;
  const auto contents = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator (folder_.file ("out")))
      files[entry.path ().string ()] = entry.is_regular_file () ? readFile (entry.path ().string ()) : "";
    return (files);
  };
  const auto before = contents ();
  std::uintmax_t largest = 0; // a scene, which meshes come before
  for (const auto& [name, text] : before)
    largest = std::max<std::uintmax_t> (largest, text.size ());
  const auto limitFiles = [largest] {
    const rlimit limit{largest / 2, largest / 2};
    setrlimit (RLIMIT_FSIZE, &limit);
  };
  ToolRun tool (arguments, folder_.file (""), limitFiles, PCL_COSECTION_EXPORT_TOOL);
  EXPECT_EQ (tool.wait (), 1);
  EXPECT_NE (tool.errors ().find ("'out/scene."), std::string::npos) << tool.errors ();
  EXPECT_TRUE (contents () == before); // not printed

  const std::string urdf = folder_.file ("out/box_1.urdf"), aside = folder_.file ("urdf");
  fs::rename (urdf, aside);
  fs::create_directory (urdf);
  EXPECT_EQ (run (arguments), 1);
  EXPECT_NE (errors_.find ("it is a folder"), std::string::npos) << errors_;
  fs::remove (urdf);
  fs::rename (aside, urdf);
  EXPECT_TRUE (contents () == before); // not printed

  fs::create_directories (folder_.file ("out/.cosection-2147483646-files.tmp/meshes")); // of a process that is gone
  EXPECT_EQ (run (arguments), 0) << errors_;
  const auto after = contents ();
  ASSERT_EQ (after.size (), before.size ());
  EXPECT_FALSE (after == before);
}

TEST_F (Export, WhatAnEarlierExportHadMoreOfIsRemoved)
{
  TriangleMesh cross = boxMesh ({-0.05f, -0.01f, 0.5f}, {0.05f, 0.01f, 0.52f});
  appendMesh (cross, boxMesh ({-0.01f, 0.02f, 0.5f}, {0.01f, 0.06f, 0.52f}));
  saveMesh (cross, folder_.file ("result/object_1.ply"));
  ASSERT_EQ (run ({"--format", "mjcf", "result", "out"}), 0) << errors_;
  ASSERT_TRUE (fs::exists (folder_.file ("out/meshes/box_1_part_1.obj")));
  ASSERT_EQ (run ({"--format", "mjcf", "--collision", "hull", "result", "out"}), 0) << errors_;
  EXPECT_TRUE (fs::exists (folder_.file ("out/meshes/box_1_part_0.obj")));
  EXPECT_FALSE (fs::exists (folder_.file ("out/meshes/box_1_part_1.obj")));
}

TEST_F (Export, ModelsOfAnEarlierExportAreWarnedOf)
{
  ASSERT_EQ (run ({"--format", "urdf", "result", "out"}), 0) << errors_;
  EXPECT_EQ (scene ()["bodies"][0]["urdf"], "box_1.urdf");
  ASSERT_EQ (run ({"--format", "mjcf", "--collision", "hull", "result", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("out/box_1.urdf and 1 more: of an earlier export"), std::string::npos) << errors_;
  EXPECT_EQ (scene ()["bodies"][0]["urdf"], nullptr);
}

TEST_F (Export, AnInterruptionLeavesWhatWasThere)
{
  ASSERT_EQ (run ({"--format", "mjcf", "result", "out"}), 0) << errors_;
  const std::string before = readFile (folder_.file ("out/scene.xml"));
  ToolRun tool ({"--format", "mjcf", "--density", "900", "--save-points", "50000", "result", "out"}, folder_.file (""),
                {}, PCL_COSECTION_EXPORT_TOOL);
  const auto isWriting = [&] {
    const fs::directory_iterator entries (folder_.file ("out"));
    return (std::any_of (begin (entries), end (entries), [] (const fs::directory_entry& entry) {
      return (entry.path ().filename ().string ()[0] == '.');
    }));
  };
  for (int n = 0; n < 6000 && !isWriting (); ++n)
    std::this_thread::sleep_for (std::chrono::milliseconds (5));
  tool.send (SIGTERM);
  EXPECT_EQ (tool.wait (), 130);
  EXPECT_EQ (readFile (folder_.file ("out/scene.xml")), before);
  EXPECT_FALSE (fs::exists (folder_.file ("out/points")));
  EXPECT_FALSE (isWriting ());
}

} // namespace
} // namespace pcl::cosection::test
