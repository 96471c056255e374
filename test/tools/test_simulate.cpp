// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_simulate as a user calls it.

#include "common/replaced.h"
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

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

const char* const small = R"({
  "frames": 4,
  "camera": {"width": 64, "height": 48, "keys": [{"position": [0, -1, 0.5], "look_at": [0, 0, 0]}]},
  "background": {"parts": [{"type": "plane"}]},
  "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "keys": [{"position": [0, 0, HEIGHT]}]}]
})";

class Simulate : public ToolTest
{
protected:
  Simulate () : ToolTest (PCL_COSECTION_SIMULATE) {}

  void writeScene (const std::string& height = "0.1") const
  {
    write ("scene.json", test::replaced (small, "HEIGHT", height));
  }
};

} // namespace

TEST_F (Simulate, WritesASceneAndASummary)
{
  writeScene ();
  EXPECT_EQ (run ({"scene.json", "out", "--json", "s.json", "--views-every", "2"}), 0) << errors_;
  EXPECT_EQ (errors_, "");
  EXPECT_EQ (output_.rfind ("wrote out: 4 frames of 64 x 48, 1 object, ", 0), 0u) << output_;
  EXPECT_TRUE (fs::exists (path ("out/views/View0001.pcd")));
  EXPECT_TRUE (fs::exists (path ("out/scene.json")));
  const nlohmann::json summary = json ("s.json");
  EXPECT_EQ (summary["frames"], 4);
  EXPECT_EQ (summary["objects"][0]["name"], "ball");
  EXPECT_TRUE (summary["warnings"].empty ());
  EXPECT_GT (summary["timings_s"]["total"], 0.0);
}

TEST_F (Simulate, SaysWhatPenetrates)
{
  writeScene ("0.08");
  EXPECT_EQ (run ({"scene.json", "out"}), 0);
  EXPECT_EQ (errors_, "pcl_cosection_simulate: warning: ball is inside room, by 20 mm at frame 0 (in 4 frames)\n");
}

TEST_F (Simulate, PresetsAreListedPrintedAndRendered)
{
  EXPECT_EQ (run ({"--list-presets"}), 0);
  for (const char* name : {"table", "toys", "stack"})
    EXPECT_NE (output_.find (std::string (name) + " "), std::string::npos);
  EXPECT_EQ (run ({"--print-preset", "stack"}), 0);
  write ("mine.json", output_);
  EXPECT_EQ (run ({"--frames", "50:51", "mine.json", "mine"}), 0) << errors_;
  EXPECT_EQ (run ({"--frames", "50:51", "--preset", "stack", "preset"}), 0) << errors_;
  EXPECT_EQ (read ("mine/depth_noise/Depth0050.png"), read ("preset/depth_noise/Depth0050.png"));
  EXPECT_GT (read ("mine/depth_noise/Depth0050.png").size (), 10000u);
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
  EXPECT_FALSE (fs::exists (path ("out")));
}

TEST_F (Simulate, BadInputIsOneLineAndWritesNothing)
{
  writeScene ();
  EXPECT_NE (failure ({"nowhere.json", "out"}, 1).find ("nowhere.json"), std::string::npos);
  write ("bad.json", "{\"frames\": }");
  EXPECT_NE (failure ({"bad.json", "out"}, 1).find ("bad.json: is not well-formed JSON"), std::string::npos);
  write ("unknown.json", "{\"camera\": {\"keys\": [{\"position\": [0,0,0]}]}, \"objects\": [], \"fps\": 3}");
  EXPECT_NE (failure ({"unknown.json", "out"}, 1).find ("unknown.json: has the unknown field \"fps\""),
             std::string::npos);
  EXPECT_NE (failure ({"--frames", "2:9", "scene.json", "out"}, 1).find ("frames 2:9 are not there; the scene has 0:4"),
             std::string::npos);
  EXPECT_NE (failure ({"scene.json", "out", "--json", "scene.json"}, 2).find ("scene.json would be overwritten"),
             std::string::npos);
  EXPECT_NE (failure ({"scene.json", "out", "--json", "no/s.json"}, 1).find ("no/s.json"), std::string::npos);
  EXPECT_NE (failure ({"scene.json", "."}, 1).find ("give the name of a new folder"), std::string::npos);
  EXPECT_FALSE (fs::exists (path ("out")));
  fs::create_directory (path ("full"));
  write ("full/mine.txt", "mine");
  EXPECT_NE (failure ({"scene.json", "full"}, 1).find ("full: is there already"), std::string::npos);
  EXPECT_NE (failure ({"scene.json", "scene.json"}, 1).find ("scene.json: is there already"), std::string::npos);
  EXPECT_EQ (folder_.entries (), 6u); // three descriptions, a folder, and what the last run printed
}

TEST_F (Simulate, PutsMeshesOnATable)
{
  fs::create_directory (path ("things"));
  saveMesh (makeBox ({0.1, 0.06, 0.2})->tessellate (0.001), path ("things/carton.ply"));
  saveMesh (makeSphere (0.04)->tessellate (0.001), path ("things/ball.ply"));
  write ("things/notes.txt", "no mesh");
  const auto simulate = [&] (std::vector<std::string> arguments) {
    arguments.insert (arguments.begin (), {"--meshes", "things", "--per-scene", "2", "--views", "2"});
    EXPECT_EQ (run (arguments), 0) << errors_;
    return output_;
  };
  EXPECT_EQ (simulate ({"--json", "s.json", "out"}), "wrote out: 1 scene of 2 objects in 2 views\n");
  const nlohmann::json summary = json ("s.json");
  std::ifstream list (path ("out/000/names.txt"));
  std::string number, name;
  list >> number >> name;
  EXPECT_TRUE (name == "ball" || name == "carton") << name;

  // The readings of each label lie on the mesh of that label; one thing may hide the other in one of the views.
  std::size_t unseen = 0;
  for (const std::uint32_t label : {1u, 2u})
  {
    const SurfaceDistance surface (loadMesh (path ("out/000/truth_" + std::to_string (label) + ".ply")));
    std::vector<Eigen::Vector3d> points;
    bool is_in_all = true;
    for (const char* view : {"out/000/view0.pcd", "out/000/view1.pcd"})
    {
      pcl::PointCloud<pcl::PointXYZRGBL> cloud;
      ASSERT_EQ (pcl::io::loadPCDFile (path (view), cloud), 0);
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
  EXPECT_EQ (read ("out/000/view1.pcd"), read ("again/000/view1.pcd"));
  EXPECT_NE (read ("out/000/view1.pcd"), read ("shifted/000/view1.pcd"));

  EXPECT_NE (failure ({"--meshes", "things", "--per-scene", "100", "full"}, 1).find ("no room for 100 things"),
             std::string::npos);
  EXPECT_FALSE (fs::exists (path ("full")));
  fs::create_directory (path ("empty"));
  EXPECT_NE (failure ({"--meshes", "empty", "x"}, 1).find ("empty: holds no meshes"), std::string::npos);
  EXPECT_NE (failure ({"--meshes", "things", "--preset", "table", "x"}, 2).find ("--meshes excludes"),
             std::string::npos);
  EXPECT_NE (failure ({"--meshes", "things"}, 2).find ("OUTPUT is missing"), std::string::npos);
  EXPECT_NE (failure ({"--preset", "table", "--views", "2", "x"}, 2).find ("--views has an effect with --meshes alone"),
             std::string::npos);
}

TEST_F (Simulate, MeshesMustBeInMetres)
{
  fs::create_directory (path ("things"));
  saveMesh (makeBox ({10.0, 6.0, 20.0})->tessellate (0.1), path ("things/carton.ply")); // centimetres
  EXPECT_NE (failure ({"--meshes", "things", "x"}, 1).find ("carton.ply: is 20 m long; the table has 1.4 m"),
             std::string::npos);
}

TEST_F (Simulate, OccludersHideThings)
{
  fs::create_directory (path ("things"));
  saveMesh (makeBox ({0.1, 0.06, 0.2})->tessellate (0.001), path ("things/carton.ply"));
  const auto readings = [&] (const char* occluders, const char* output) {
    EXPECT_EQ (run ({"--meshes", "things", "--per-scene", "1", "--views", "1", "--occluders", occluders, output}), 0)
        << errors_;
    pcl::PointCloud<pcl::PointXYZRGBL> cloud;
    EXPECT_EQ (pcl::io::loadPCDFile (path (output + std::string ("/000/view0.pcd")), cloud), 0);
    return std::count_if (cloud.begin (), cloud.end (), [] (const auto& p) { return p.label == 1; });
  };
  const auto all = readings ("0", "free");
  EXPECT_LT (readings ("3", "hidden"), 0.9 * static_cast<double> (all));
}
