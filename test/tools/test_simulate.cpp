// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_simulate as a user calls it.

#include "common/temporary_folder.h"
#include "simulate_command_line.h"
#include "tool_run.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/simulation/simulated_scene.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

const char* const small = R"({
  "frames": 4,
  "camera": {"width": 64, "height": 48, "keys": [{"position": [0, -1, 0.5], "look_at": [0, 0, 0]}]},
  "background": {"parts": [{"type": "plane"}]},
  "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "keys": [{"position": [0, 0, HEIGHT]}]}]
})";

class Simulate : public testing::Test
{
protected:
  void writeScene (const std::string& height = "0.1") const
  {
    std::string text = small;
    text.replace (text.find ("HEIGHT"), 6, height);
    std::ofstream (folder_.file ("scene.json")) << text;
  }

  std::string failure (const std::vector<std::string>& arguments, int status) const
  {
    ToolRun run (arguments, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
    EXPECT_EQ (run.wait (), status);
    const std::string errors = run.errors ();
    EXPECT_EQ (errors.rfind ("pcl_cosection_simulate: error: ", 0), 0u) << errors;
    EXPECT_EQ (errors.find ('\n'), errors.size () - 1) << errors;
    return errors;
  }

  const test::TemporaryFolder folder_;
};

} // namespace

TEST_F (Simulate, WritesASceneAndASummary)
{
  writeScene ();
  ToolRun run ({"scene.json", "out", "--json", "s.json", "--views-every", "2"}, folder_.file (""), {},
               PCL_COSECTION_SIMULATE);
  EXPECT_EQ (run.wait (), 0) << run.errors ();
  EXPECT_EQ (run.errors (), "");
  EXPECT_EQ (run.output ().rfind ("wrote out: 4 frames of 64 x 48, 1 object, ", 0), 0u) << run.output ();
  EXPECT_TRUE (fs::exists (folder_.file ("out/views/View0001.pcd")));
  EXPECT_TRUE (fs::exists (folder_.file ("out/scene.json")));
  std::ifstream file (folder_.file ("s.json"));
  const nlohmann::json summary = nlohmann::json::parse (file);
  EXPECT_EQ (summary["frames"], 4);
  EXPECT_EQ (summary["objects"][0]["name"], "ball");
  EXPECT_TRUE (summary["warnings"].empty ());
  EXPECT_GT (summary["timings_s"]["total"], 0.0);
}

TEST_F (Simulate, SaysWhatPenetrates)
{
  writeScene ("0.08");
  ToolRun run ({"scene.json", "out"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  EXPECT_EQ (run.wait (), 0);
  EXPECT_EQ (run.errors (),
             "pcl_cosection_simulate: warning: ball is inside room, by 20 mm at frame 0 (in 4 frames)\n");
}

TEST_F (Simulate, PresetsAreListedPrintedAndRendered)
{
  ToolRun list ({"--list-presets"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  EXPECT_EQ (list.wait (), 0);
  for (const char* name : {"table", "toys", "stack"})
    EXPECT_NE (list.output ().find (std::string (name) + " "), std::string::npos);
  ToolRun print ({"--print-preset", "stack"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  EXPECT_EQ (print.wait (), 0);
  std::ofstream (folder_.file ("mine.json")) << print.output ();
  ToolRun mine ({"--frames", "50:51", "mine.json", "mine"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  EXPECT_EQ (mine.wait (), 0) << mine.errors ();
  ToolRun preset ({"--frames", "50:51", "--preset", "stack", "preset"}, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
  EXPECT_EQ (preset.wait (), 0) << preset.errors ();
  const auto bytes = [&] (const std::string& name) {
    std::ifstream in (folder_.file (name), std::ios::binary);
    return std::string (std::istreambuf_iterator<char> (in), {});
  };
  EXPECT_EQ (bytes ("mine/depth_noise/Depth0050.png"), bytes ("preset/depth_noise/Depth0050.png"));
  EXPECT_GT (bytes ("mine/depth_noise/Depth0050.png").size (), 10000u);
}

TEST_F (Simulate, WrongUsageIsOneLine)
{
  writeScene ();
  EXPECT_NE (failure ({}, 2).find ("SPEC.json and OUTPUT are missing"), std::string::npos);
  EXPECT_NE (failure ({"scene.json"}, 2).find ("OUTPUT is missing after scene.json"), std::string::npos);
  EXPECT_NE (failure ({"--preset", "table"}, 2).find ("OUTPUT is missing"), std::string::npos);
  EXPECT_NE (failure ({"--preset", "tabel", "out"}, 2).find ("no preset tabel; did you mean table?"),
             std::string::npos);
  EXPECT_NE (failure ({"--preset", "table", "scene.json", "out"}, 2).find ("one argument too many: out"),
             std::string::npos);
  EXPECT_NE (failure ({"--sead", "3", "scene.json", "out"}, 2).find ("did you mean --seed?"), std::string::npos);
  for (const char* frames : {"3", "a:b", "3:2", "-1:2", "1:2:3", "1.5:2"})
    EXPECT_NE (failure ({"--frames", frames, "scene.json", "out"}, 2).find ("--frames"), std::string::npos) << frames;
  EXPECT_NE (failure ({"--seed", "-1", "scene.json", "out"}, 2).find ("--seed"), std::string::npos);
  EXPECT_FALSE (fs::exists (folder_.file ("out")));
}

TEST_F (Simulate, BadInputIsOneLineAndWritesNothing)
{
  writeScene ();
  EXPECT_NE (failure ({"nowhere.json", "out"}, 1).find ("nowhere.json"), std::string::npos);
  std::ofstream (folder_.file ("bad.json")) << "{\"frames\": }";
  EXPECT_NE (failure ({"bad.json", "out"}, 1).find ("bad.json: is not well-formed JSON"), std::string::npos);
  std::ofstream (folder_.file ("unknown.json"))
      << "{\"camera\": {\"keys\": [{\"position\": [0,0,0]}]}, \"objects\": [], \"fps\": 3}";
  EXPECT_NE (failure ({"unknown.json", "out"}, 1).find ("unknown.json: has the unknown field \"fps\""),
             std::string::npos);
  EXPECT_NE (failure ({"--frames", "2:9", "scene.json", "out"}, 1).find ("frames 2:9 are not there; the scene has 0:4"),
             std::string::npos);
  EXPECT_NE (failure ({"scene.json", "out", "--json", "scene.json"}, 2).find ("scene.json would be overwritten"),
             std::string::npos);
  EXPECT_NE (failure ({"scene.json", "out", "--json", "no/s.json"}, 1).find ("no/s.json"), std::string::npos);
  EXPECT_NE (failure ({"scene.json", "."}, 1).find ("give the name of a new folder"), std::string::npos);
  EXPECT_FALSE (fs::exists (folder_.file ("out")));
  fs::create_directory (folder_.file ("full"));
  std::ofstream (folder_.file ("full/mine.txt")) << "mine";
  EXPECT_NE (failure ({"scene.json", "full"}, 1).find ("full: is there already"), std::string::npos);
  EXPECT_NE (failure ({"scene.json", "scene.json"}, 1).find ("scene.json: is there already"), std::string::npos);
  EXPECT_EQ (folder_.entries (), 6u); // three descriptions, a folder, and what the last run printed
}

TEST_F (Simulate, PutsMeshesOnATable)
{
  fs::create_directory (folder_.file ("things"));
  saveMesh (makeBox ({0.1, 0.06, 0.2})->tessellate (0.001), folder_.file ("things/carton.ply"));
  saveMesh (makeSphere (0.04)->tessellate (0.001), folder_.file ("things/ball.ply"));
  std::ofstream (folder_.file ("things/notes.txt")) << "no mesh";
  const auto simulate = [&] (std::vector<std::string> arguments) {
    arguments.insert (arguments.begin (), {"--meshes", "things", "--per-scene", "2", "--views", "2"});
    ToolRun run (arguments, folder_.file (""), {}, PCL_COSECTION_SIMULATE);
    EXPECT_EQ (run.wait (), 0) << run.errors ();
    return run.output ();
  };
  EXPECT_EQ (simulate ({"--json", "s.json", "out"}), "wrote out: 1 scene of 2 objects in 2 views\n");
  std::ifstream summary_file (folder_.file ("s.json"));
  const nlohmann::json summary = nlohmann::json::parse (summary_file);
  std::ifstream list (folder_.file ("out/000/names.txt"));
  std::string number, name;
  list >> number >> name;
  EXPECT_TRUE (name == "ball" || name == "carton") << name;

  // The readings of each label lie on the mesh of that label; one thing may hide the other in one of the views.
  std::size_t unseen = 0;
  for (const std::uint32_t label : {1u, 2u})
  {
    const SurfaceDistance surface (loadMesh (folder_.file ("out/000/truth_" + std::to_string (label) + ".ply")));
    std::vector<Eigen::Vector3d> points;
    bool is_in_all = true;
    for (const char* view : {"out/000/view0.pcd", "out/000/view1.pcd"})
    {
      pcl::PointCloud<pcl::PointXYZRGBL> cloud;
      ASSERT_EQ (pcl::io::loadPCDFile (folder_.file (view), cloud), 0);
      Eigen::Isometry3f pose (cloud.sensor_orientation_);
      pose.translation () = cloud.sensor_origin_.head<3> ();
      const std::size_t before = points.size ();
      for (const auto& p : cloud)
        if (p.label == label && p.getVector3fMap ().allFinite ())
          points.push_back ((pose * p.getVector3fMap ()).cast<double> ());
      is_in_all = is_in_all && points.size () > before;
    }
    ASSERT_GT (points.size (), 500u);
    unseen += !is_in_all;
    EXPECT_LT (errorStatistics (surface.of (points)).median, 0.002);
  }

  EXPECT_EQ (summary["warnings"].size (), unseen) << summary;

  // The same seed gives the same bytes; labels may be wrong on purpose.
  simulate ({"again"});
  simulate ({"--mask-shift", "5", "shifted"});
  const auto bytes = [&] (const std::string& file) {
    std::ifstream in (folder_.file (file), std::ios::binary);
    return std::string (std::istreambuf_iterator<char> (in), {});
  };
  EXPECT_EQ (bytes ("out/000/view1.pcd"), bytes ("again/000/view1.pcd"));
  EXPECT_NE (bytes ("out/000/view1.pcd"), bytes ("shifted/000/view1.pcd"));

  EXPECT_NE (failure ({"--meshes", "things", "--per-scene", "100", "full"}, 1).find ("no room for 100 things"),
             std::string::npos);
  EXPECT_FALSE (fs::exists (folder_.file ("full")));
  fs::create_directory (folder_.file ("empty"));
  EXPECT_NE (failure ({"--meshes", "empty", "x"}, 1).find ("empty: holds no meshes"), std::string::npos);
  EXPECT_NE (failure ({"--meshes", "things", "--preset", "table", "x"}, 2).find ("--meshes excludes"),
             std::string::npos);
  EXPECT_NE (failure ({"--meshes", "things"}, 2).find ("OUTPUT is missing"), std::string::npos);
  EXPECT_NE (failure ({"--preset", "table", "--views", "2", "x"}, 2).find ("--views has an effect with --meshes alone"),
             std::string::npos);
}

TEST_F (Simulate, MeshesMustBeInMetres)
{
  fs::create_directory (folder_.file ("things"));
  saveMesh (makeBox ({10.0, 6.0, 20.0})->tessellate (0.1), folder_.file ("things/carton.ply")); // centimetres
  EXPECT_NE (failure ({"--meshes", "things", "x"}, 1).find ("carton.ply: is 20 m long; the table has 1.4 m"),
             std::string::npos);
}

TEST_F (Simulate, OccludersHideThings)
{
  fs::create_directory (folder_.file ("things"));
  saveMesh (makeBox ({0.1, 0.06, 0.2})->tessellate (0.001), folder_.file ("things/carton.ply"));
  const auto readings = [&] (const char* occluders, const char* output) {
    ToolRun run ({"--meshes", "things", "--per-scene", "1", "--views", "1", "--occluders", occluders, output},
                 folder_.file (""), {}, PCL_COSECTION_SIMULATE);
    EXPECT_EQ (run.wait (), 0) << run.errors ();
    pcl::PointCloud<pcl::PointXYZRGBL> cloud;
    EXPECT_EQ (pcl::io::loadPCDFile (folder_.file (output + std::string ("/000/view0.pcd")), cloud), 0);
    return std::count_if (cloud.begin (), cloud.end (), [] (const auto& p) { return p.label == 1; });
  };
  const auto all = readings ("0", "free");
  EXPECT_LT (readings ("3", "hidden"), 0.9 * static_cast<double> (all));
}
