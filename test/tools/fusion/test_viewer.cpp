// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_viewer as a user calls it where there is no display.

#include "fused_scene.h"

#include "tools/scene_files.h"

#include "pcl_cosection/io/image_io.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <set>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Viewer = FusedScene;

std::set<std::array<std::uint8_t, 3>>
coloursOf (const Picture& picture)
{
  return {picture.pixels.begin (), picture.pixels.end ()};
}

} // namespace

TEST_F (Viewer, ScreenshotNeedsNoDisplay)
{
  const auto before = snapshot (".");
  ASSERT_EQ (view ({"--screenshot", "scene.png", "--size", "320x200", "out"}), 0) << errors_;
  EXPECT_EQ (output_, "wrote scene.png: frame 12 of 12, 320 x 200\n");
  EXPECT_EQ (errors_, "");
  const Picture picture = loadColourImage (file ("scene.png"));
  EXPECT_EQ (picture.width, 320);
  EXPECT_EQ (picture.height, 200);
  EXPECT_GT (coloursOf (picture).size (), 500u);
  auto after = snapshot (".");
  for (const char* made : {"scene.png", "tool_stdout.txt", "tool_stderr.txt"})
    after.erase (made);
  auto expected = before;
  for (const char* made : {"tool_stdout.txt", "tool_stderr.txt"})
    expected.erase (made);
  EXPECT_EQ (after, expected); // the run and the sequence are as they were
}

TEST_F (Viewer, EveryModeIsAnotherPicture)
{
  const std::vector<Words> modes = {{},
                                    {"--colour", "instance"},
                                    {"--colour", "provenance"},
                                    {"--colour", "confidence"},
                                    {"--colour", "error", "--truth", "sim"},
                                    {"--mode", "tsdf"},
                                    {"--mode", "points"},
                                    {"--view", "behind"},
                                    {"--view", "camera"},
                                    {"--boxes"},
                                    {"--frame", "0"},
                                    {"--hide", "background"},
                                    {"--hide", "objects"},
                                    {"--hide", "frustum"},
                                    {"--hide", "path"},
                                    {"--hide", "caption"},
                                    {"--triangles", "200"}};
  std::set<std::string> pictures;
  for (const Words& mode : modes)
  {
    Words words = {"--screenshot", "scene.png", "--size", "200x150", "out"};
    words.insert (words.begin (), mode.begin (), mode.end ());
    ASSERT_EQ (view (words), 0) << errors_;
    EXPECT_TRUE (pictures.insert (readFile (file ("scene.png"))).second) << testing::PrintToString (mode);
    ASSERT_EQ (view (words), 0) << errors_;
    EXPECT_FALSE (pictures.insert (readFile (file ("scene.png"))).second)
        << testing::PrintToString (mode); // the same every time
  }
}

TEST_F (Viewer, CompletedViewsAreShown)
{
  writeTableScene (file ("table.pcd"));
  ToolRun completion ({"--voxel-size", "0.01", "table.pcd", "table"}, file (""));
  ASSERT_EQ (completion.wait (), 0) << completion.errors ();
  std::set<std::string> pictures;
  for (const Words& mode :
       std::vector<Words>{{}, {"--view", "behind"}, {"--view", "camera"}, {"--colour", "provenance"}})
  {
    Words words = {"--screenshot", "table.png", "--size", "200x150", "table"};
    words.insert (words.begin (), mode.begin (), mode.end ());
    ASSERT_EQ (view (words), 0) << errors_;
    EXPECT_EQ (errors_, "");
    EXPECT_EQ (output_, "wrote table.png: frame 1 of 1, 200 x 150\n");
    EXPECT_TRUE (pictures.insert (readFile (file ("table.png"))).second) << testing::PrintToString (mode);
  }
  ASSERT_EQ (view ({"--screenshot", "table.png", "--mode", "tsdf", "table"}), 0);
  EXPECT_NE (errors_.find ("has no surfaces as they were seen"), std::string::npos) << errors_;
  expectNoView ({"--screenshot", "table.png", "--mode", "points", "--dataset", "sim", "table"}, 1,
                "there are no points to show");
  const nlohmann::json summary = json ("table/summary.json");
  EXPECT_EQ (summary["views"][0]["input"], 0);
  EXPECT_EQ (summary["views"][0]["camera"]["width"], 160);
  fs::remove (file ("table/summary.json"));
  ASSERT_EQ (view ({"--screenshot", "table.png", "table"}), 0) << errors_;
  EXPECT_NE (errors_.find ("a place is assumed"), std::string::npos) << errors_;
}

TEST_F (Viewer, FramesAreRecorded)
{
  ASSERT_EQ (view ({"--record", "film", "--size", "160x120", "--every", "5", "out"}), 0) << errors_;
  EXPECT_EQ (output_, "wrote film: 3 frames of 160 x 120\n");
  EXPECT_EQ (filesIn ("film"), (Words{"Frame00001.png", "Frame00002.png", "Frame00003.png"}));
  ASSERT_EQ (view ({"--screenshot", "sixth.png", "--size", "160x120", "--frame", "5", "out"}), 0) << errors_;
  EXPECT_EQ (readFile (file ("film/Frame00002.png")), readFile (file ("sixth.png")));
}

TEST_F (Viewer, WithoutDisplayItSaysSo)
{
  expectNoView ({"out"}, 1, "no window can be opened");
  EXPECT_NE (errors_.find ("--screenshot FILE.png"), std::string::npos);
#ifdef PCL_COSECTION_HAS_WINDOW
  EXPECT_EQ (view ({"out"}, [] { setenv ("DISPLAY", ":4711", 1); }), 1);
  EXPECT_EQ (
      errors_,
      "pcl_cosection_viewer: error: no window can be opened: the display :4711 that DISPLAY names does not answer; "
      "--screenshot FILE.png and --record DIR draw without one\n");
#endif
}

TEST_F (Viewer, TheRunIsNotWrittenTo)
{
  const auto before = snapshot ("out");
  for (const char* path : {"out/scene.png", "out/mesh/object_1.png", "./out/../out/scene.png", "link.png",
                           "dangling.png", "sim/scene.png"})
  {
    std::error_code ignored;
    fs::create_symlink (file ("out/mesh/object_1.ply"), file ("link.png"), ignored);
    fs::create_symlink (file ("out/new.png"), file ("dangling.png"), ignored);
    expectNoView ({"--screenshot", path, "--truth", "sim", "out"}, 2, "which is only read");
  }
  expectNoView ({"--record", "out", "out"}, 2, "which is only read");
  expectNoView ({"--record", "out/film", "out"}, 2, "which is only read");
  EXPECT_EQ (snapshot ("out"), before);
}

TEST_F (Viewer, OtherFoldersAreTold)
{
  const Words picture = {"--screenshot", "scene.png"};
  const auto with = [&picture] (const std::string& folder) {
    Words words = picture;
    words.push_back (folder);
    return (words);
  };
  expectNoView (with ("nowhere"), 1, "nowhere: is no folder");
  expectNoView (with ("sim"), 1, "sim: is a dataset");
  fs::create_directory (file ("foreign"));
  expectNoView (with ("foreign"), 1,
                "foreign: has no trajectory/camera.txt: it is not what pcl_cosection_fusion or pcl_cosection wrote");
  expectNoView (with ("sim/calibration.txt"), 1, "is no folder");
  writeFile (file ("foreign/summary.json"), R"({"error": "no frame can be read"})");
  expectNoView (with ("foreign"), 1, "that run failed: no frame can be read");
  writeFile (file ("out/trajectory/camera.txt"), "0 1 2\n");
  expectNoView (with ("out"), 1, "camera.txt");
  EXPECT_FALSE (exists ("scene.png"));
}

TEST_F (Viewer, PartOfARunIsShown)
{
  fs::remove (file ("out/summary.json"));
  fs::remove (file ("out/mesh/background.ply"));
  writeFile (file ("out/mesh/object_1.ply"), "ply\nformat");
  ASSERT_EQ (view ({"--screenshot", "scene.png", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("warning: out: has no summary.json"), std::string::npos) << errors_;
  EXPECT_NE (errors_.find ("object_1.ply"), std::string::npos) << errors_;
  fs::remove_all (file ("out/mesh"));
  ASSERT_EQ (view ({"--screenshot", "scene.png", "out"}), 0) << errors_;
  EXPECT_NE (errors_.find ("has no meshes"), std::string::npos) << errors_;
}

TEST_F (Viewer, WrongUsageIsTold)
{
  expectNoView ({}, 2, "OUTPUT is missing");
  expectNoView ({"out", "more"}, 2, "one argument too many: more");
  expectNoView ({""}, 2, "OUTPUT is empty");
  expectNoView ({"--screenshoot", "a.png", "out"}, 2, "did you mean --screenshot?");
  expectNoView ({"--screenshot", "a.jpg", "out"}, 2, "must end in .png");
  expectNoView ({"--screenshot", "a.png", "--record", "film", "out"}, 2, "exclude each other");
  expectNoView ({"--screenshot", "a.png", "--colour", "error", "out"}, 2, "--truth DATASET");
  expectNoView ({"--screenshot", "a.png", "--colour", "pink", "out"}, 2, "--colour");
  expectNoView ({"--screenshot", "a.png", "--size", "640", "out"}, 2, "--size must be WIDTHxHEIGHT");
  expectNoView ({"--screenshot", "a.png", "--size", "10x10", "out"}, 2, "from 64 to 8192");
  expectNoView ({"--screenshot", "a.png", "--frame", "40", "out"}, 1, "it has those from 0 to 11");
  expectNoView ({"--screenshot", "a.png", "--viewpoint", "no.json", "out"}, 1, "no.json: cannot be read");
  expectNoView ({"--screenshot", "a.png", "--view", "camera", "--viewpoint", "no.json", "out"}, 2,
                "exclude each other");
  expectNoView ({"--screenshot", "no/a.png", "out"}, 1, "there is no folder no");
  expectNoView ({"--screenshot", "a.png", "--mode", "points", "--dataset", "no", "out"}, 1, "no");
  expectNoView ({"--screenshot", "a.png", "--truth", "no", "out"}, 1, "no: is no folder");
  expectNoView ({"--every", "2", "out"}, 2, "--every needs --record");
  expectNoView ({"--follow", "x", "--screenshot", "a.png", "out"}, 2, "--follow needs a window");
  EXPECT_FALSE (exists ("a.png"));
}

TEST_F (Viewer, AViewpointIsTaken)
{
  writeFile (file ("view.json"), R"({"eye": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "angle_deg": 30})");
  ASSERT_EQ (view ({"--screenshot", "a.png", "--viewpoint", "view.json", "out"}), 0) << errors_;
  ASSERT_EQ (view ({"--screenshot", "b.png", "out"}), 0) << errors_;
  EXPECT_NE (readFile (file ("a.png")), readFile (file ("b.png")));
  expectNoView ({"--screenshot", "view.json/../view.png", "--viewpoint", "view.json", "nowhere"}, 1, "");
}

TEST_F (Viewer, TheSummaryTellsTheCamera)
{
  const nlohmann::json summary = json ("out/summary.json");
  EXPECT_EQ (summary["camera"]["width"], 120);
  EXPECT_EQ (summary["camera"]["height"], 90);
  EXPECT_GT (summary["camera"]["fx"], 50.0);
  EXPECT_EQ (summary["parameters"]["images"]["format"], "");
}
