// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Views that nobody has labelled, of which the program uses the space that they saw free; and what any view takes from
// hulls.

#include "common/temporary_folder.h"
#include "scene_files.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

constexpr int views = 5;
constexpr int objects = 3;

/** \brief A ball, a corner of a wall and a bowl on a table, and a camera that goes around them; with a camera's noise.
 */
nlohmann::json
sceneOf ()
{
  const auto at = [] (double x, double y, double z) { return nlohmann::json::array ({{{"position", {x, y, z}}}}); };
  nlohmann::json keys;
  for (int v = 0; v < views; ++v)
  {
    const double angle = 2.0 * M_PI * v / views;
    keys.push_back ({{"time", v},
                     {"position", {0.8 * std::cos (angle), 0.8 * std::sin (angle), 0.6}},
                     {"look_at", {0.0, 0.0, 0.05}}});
  }
  return {{"frames", views},
          {"rate", 1},
          {"camera", {{"width", 640}, {"height", 480}, {"keys", keys}}},
          {"views", {{"every", 1}}},
          {"background", {{"parts", {{{"type", "plane"}, {"extent", 3}}}}}},
          {"objects",
           {{{"name", "ball"}, {"shape", {{"type", "sphere"}, {"radius", 0.05}}}, {"keys", at (0.15, 0.12, 0.0505)}},
            {{"name", "corner"},
             {"shape",
              {{"type", "extrusion"},
               {"outline", {{0, 0}, {0.16, 0}, {0.16, 0.05}, {0.05, 0.05}, {0.05, 0.16}, {0, 0.16}}},
               {"height", 0.1}}},
             {"keys", at (-0.2, -0.2, 0.0005)}},
            {{"name", "bowl"},
             {"shape",
              {{"type", "revolution"},
               {"profile", {{0, 0}, {0.04, 0}, {0.08, 0.06}, {0.072, 0.06}, {0.036, 0.008}, {0, 0.008}}}}},
             {"keys", at (0.15, -0.15, 0.0005)}}}}};
}

class FreeSpaceViews : public testing::Test
{
protected:
  static void SetUpTestSuite ()
  {
    folder_ = std::make_unique<pcl::cosection::test::TemporaryFolder> ();
    std::ofstream (folder_->file ("scene.json")) << sceneOf ();
    ToolRun tool ({"scene.json", "sim"}, folder_->file (""), {}, PCL_COSECTION_SIMULATE);
    ASSERT_EQ (tool.wait (), 0) << tool.errors ();
  }

  static void TearDownTestSuite () { folder_.reset (); }

  static std::string view (int v) { return "sim/views/View000" + std::to_string (v) + ".pcd"; }

  int run (const std::vector<std::string>& arguments)
  {
    ToolRun tool (arguments, folder_->file (""));
    const int status = tool.wait ();
    errors_ = tool.errors ();
    return status;
  }

  static double volume (const std::string& name)
  {
    const TriangleMesh mesh = loadMesh (folder_->file (name));
    EXPECT_TRUE (computeTopology (mesh).closed_manifold) << name;
    return computeMassProperties (mesh).volume_m3;
  }

  static std::unique_ptr<pcl::cosection::test::TemporaryFolder> folder_;
  std::string errors_;
};

std::unique_ptr<pcl::cosection::test::TemporaryFolder> FreeSpaceViews::folder_;

} // namespace

TEST_F (FreeSpaceViews, HullsShrinkWithEachView)
{
  constexpr std::size_t corner = 1;
  for (const std::string priors : {"all", "none"})
  {
    SCOPED_TRACE ("priors: " + priors);
    std::vector<std::string> arguments{"--constraints", "hull", "--save-hull", "--quiet"};
    if (priors == "none")
      arguments.insert (arguments.end (), {"--priors", "none"});
    const double body_growth = priors == "none" ? 1.005 : 1.02; // smoothness may give a little elsewhere
    std::vector<double> first, before;
    for (int v = 0; v < views; ++v)
    {
      if (v > 0)
        arguments.insert (arguments.end (), {"--free-space", view (v)});
      const std::string output = priors + std::to_string (v);
      std::vector<std::string> all = arguments;
      all.insert (all.end (), {view (0), output});
      ASSERT_EQ (run (all), 0) << errors_;
      std::vector<double> now;
      for (int id = 1; id <= objects; ++id)
        for (const char* what : {"_hull.ply", ".ply"})
          now.push_back (volume (output + "/object_" + std::to_string (id) + what));
      for (std::size_t n = 0; n < before.size (); n += 2)
      {
        EXPECT_LE (now[n], 1.001 * before[n]) << "hull of object " << n / 2 + 1 << ", " << v + 1 << " views";
        // Without its table, a level mirror plane guesses the corner's foot, which may grow where a view dents it less.
        if (priors == "none" || n / 2 != corner)
        {
          EXPECT_LE (now[n + 1], body_growth * before[n + 1]) << "object " << n / 2 + 1 << ", " << v + 1 << " views";
        }
      }
      if (v == 0)
        first = now;
      before = now;
    }
    for (std::size_t n = 0; n < first.size (); n += 2)
      EXPECT_LT (before[n], 0.995 * first[n]) << "hull of object " << n / 2 + 1;
  }
}

// The bowl's inside is known to go on to a floor; without that, free space is all that tells of it.
TEST_F (FreeSpaceViews, TellOfWhatIsNotGuessed)
{
  std::vector<std::string> arguments{"--preset", "paper", "--constraints", "hull", "--quiet", view (0), "one"};
  ASSERT_EQ (run (arguments), 0) << errors_;
  arguments.back () = "all";
  for (int v = 1; v < views; ++v)
    arguments.insert (arguments.begin (), {"--free-space", view (v)});
  ASSERT_EQ (run (arguments), 0) << errors_;
  EXPECT_LT (volume ("all/object_3.ply"), 0.98 * volume ("one/object_3.ply"));
}

TEST_F (FreeSpaceViews, MergedViewsShrinkHullsToo)
{
  for (const char* constraints : {"hull", "all"})
  {
    std::vector<std::string> arguments{"--save-hull", "--quiet", "--constraints", constraints};
    std::vector<double> before;
    for (int v = 0; v < views; ++v)
    {
      arguments.push_back (view (v));
      std::vector<std::string> all = arguments;
      all.push_back ("merged" + std::to_string (v));
      ASSERT_EQ (run (all), 0) << errors_;
      std::vector<double> now;
      for (int id = 1; id <= objects; ++id)
        now.push_back (volume (all.back () + "/object_" + std::to_string (id) + "_hull.ply"));
      for (std::size_t n = 0; n < before.size (); ++n)
        EXPECT_LE (now[n], 1.01 * before[n]) << "object " << n + 1 << ", " << v + 1 << " views";
      before = now;
    }
  }
}

TEST_F (FreeSpaceViews, NeedNoLabelsAndTellNothingElse)
{
  ASSERT_EQ (run ({"--free-space", view (2), "--json", "s.json", view (0), "more"}), 0) << errors_;
  std::ifstream file (folder_->file ("s.json"));
  EXPECT_EQ (nlohmann::json::parse (file)["parameters"]["free_space"][0], view (2));
  ASSERT_EQ (run ({view (0), "less"}), 0) << errors_;
  for (int id = 1; id <= objects; ++id)
  {
    const std::string name = "/object_" + std::to_string (id) + ".ply";
    EXPECT_LE (volume ("more" + name), 1.02 * volume ("less" + name)); // as above; the corner is nearer its true volume
  }
  // A background of one view only, although the other shows more of it.
  EXPECT_EQ (loadMesh (folder_->file ("more/background.ply")).vertices.size (),
             loadMesh (folder_->file ("less/background.ply")).vertices.size ());
}

TEST_F (FreeSpaceViews, FollowTheInputsInTrajectories)
{
  std::ofstream (folder_->file ("rests.txt")) << "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
  const auto hull = [&] (const std::vector<std::string>& options, const std::string& output) {
    std::vector<std::string> all{"--save-hull", "--free-space", view (2), view (0), output};
    all.insert (all.begin (), options.begin (), options.end ());
    EXPECT_EQ (run (all), 0) << errors_;
    return volume (output + "/object_3_hull.ply");
  };
  const double free = hull ({}, "free");
  EXPECT_NEAR (hull ({"--object-trajectory", "3=rests.txt"}, "follows"), free, 0.02 * free);
  std::ofstream (folder_->file ("short.txt")) << "0 0 0 0 0 0 0 1\n"; // says nothing of the second view
  EXPECT_GT (hull ({"--object-trajectory", "3=short.txt"}, "short"), 1.02 * free);
}

TEST_F (FreeSpaceViews, AWrongPoseIsSaid)
{
  std::ifstream right (folder_->file (view (2)), std::ios::binary);
  std::ofstream wrong (folder_->file ("wrong.pcd"), std::ios::binary);
  for (std::string line; line.rfind ("DATA", 0) != 0 && std::getline (right, line);)
    wrong << (line.rfind ("VIEWPOINT", 0) == 0 ? "VIEWPOINT 0 0 0.8 0 1 0 0" : line) << "\n"; // from straight above
  wrong << right.rdbuf ();
  wrong.close ();
  const auto warnings = [&] (const std::string& file) {
    EXPECT_EQ (run ({"--free-space", file, "--json", "w.json", view (0), "w"}), 0) << errors_;
    std::ifstream json (folder_->file ("w.json"));
    return nlohmann::json::parse (json)["warnings"].dump ();
  };
  EXPECT_EQ (warnings (view (2)), "[]");
  EXPECT_NE (warnings ("wrong.pcd").find ("looks through"), std::string::npos);
}

TEST_F (FreeSpaceViews, BadOnesAreRefused)
{
  EXPECT_EQ (run ({"--free-space", "none.pcd", view (0), "no"}), 1);
  EXPECT_NE (errors_.find ("none.pcd"), std::string::npos) << errors_;
  writeSphere (folder_->file ("ball.pcd"), 1000); // from all sides
  EXPECT_EQ (run ({"--free-space", "ball.pcd", view (0), "no"}), 1);
  EXPECT_NE (errors_.find ("ball.pcd: shows no free space"), std::string::npos) << errors_;
  EXPECT_FALSE (fs::exists (folder_->file ("no")));
  EXPECT_EQ (run ({"--free-space", view (2), "--json", view (2), view (0), "no"}), 2) << errors_;
  EXPECT_EQ (run ({"--free-space"}), 2);
  // In millimetres: said, as of an INPUT.
  EXPECT_EQ (run ({"--scale", "1000", "--free-space", view (2), "--voxel-size", "10", view (0), "large"}), 0)
      << errors_;
  EXPECT_NE (errors_.find (view (2) + ": extends over"), std::string::npos) << errors_;
}
