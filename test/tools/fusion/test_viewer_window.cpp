// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The window of pcl_cosection_viewer and of pcl_cosection_fusion --live, at a display that nobody sees.

#include "fused_scene.h"
#include "virtual_display.h"

#include "pcl_cosection/io/image_io.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>
#include <thread>

#ifdef PCL_COSECTION_HAS_WINDOW

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class ViewerWindow : public FusedScene
{
protected:
  void SetUp () override
  {
    if (display_.name ().empty ())
      GTEST_SKIP () << "Xvfb and xdotool are not installed";
  }

  /** \brief Start the viewer and wait for its window. */
  std::unique_ptr<ToolRun> open (const Words& more = {})
  {
    Words words = {"--verbose", "--size", "400x300", "out"};
    words.insert (words.begin (), more.begin (), more.end ());
    auto run = std::make_unique<ToolRun> (words, file (""), display_.asDisplay (), PCL_COSECTION_VIEWER);
    EXPECT_TRUE (run->waitForError ("h: help")) << run->errors ();
    window_ = display_.window ("pcl_cosection_viewer: out");
    EXPECT_NE (window_, "");
    return (run);
  }

  void press (const std::string& key) const { display_.act ({"key", "--window", window_, key}); }

  /** \brief Press a key; the window says so. */
  void expectAfter (const std::string& key, const std::string& said, ToolRun& run) const
  {
    press (key);
    EXPECT_TRUE (run.waitForError (said)) << key << ": " << said << '\n' << run.errors ();
  }

  /** \brief Wait for a file. */
  bool appears (const std::string& name) const
  {
    for (int n = 0; n < 600 && !exists (name); ++n)
      std::this_thread::sleep_for (std::chrono::milliseconds (100));
    return (exists (name));
  }

  const VirtualDisplay display_;
  std::string window_;
};

/** \brief Share of the pixels of the upper part that clearly differ. */
double
differingShare (const Picture& a, const Picture& b)
{
  EXPECT_EQ (a.width, b.width);
  EXPECT_EQ (a.height, b.height);
  constexpr double upper = 0.8; // below is the slider
  constexpr int much = 40;
  std::size_t count = 0, differing = 0;
  for (int v = 0; v < upper * a.height; ++v)
    for (int u = 0; u < a.width; ++u)
    {
      ++count;
      int most = 0;
      for (std::size_t channel = 0; channel < 3; ++channel)
        most = std::max (most, std::abs (int{a.at (u, v)[channel]} - int{b.at (u, v)[channel]}));
      differing += most > much;
    }
  return (static_cast<double> (differing) / static_cast<double> (count));
}

} // namespace

TEST_F (ViewerWindow, KeysDoWhatTheHelpSays)
{
  const auto before = snapshot ("out");
  const auto run = open ({"--truth", "sim"});
  const std::vector<std::pair<std::string, std::string>> keys = {{"Right", "frame 2 of 12"},
                                                                 {"Right", "frame 3 of 12"},
                                                                 {"Left", "frame 2 of 12"},
                                                                 {"End", "frame 12 of 12"},
                                                                 {"Prior", "frame 2 of 12"},
                                                                 {"Next", "frame 12 of 12"},
                                                                 {"5", "frame 6 of 12"},
                                                                 {"Home", "frame 1 of 12"},
                                                                 {"m", "surfaces tsdf"},
                                                                 {"m", "surfaces points"},
                                                                 {"m", "surfaces completed"},
                                                                 {"c", "colours instance"},
                                                                 {"c", "colours provenance"},
                                                                 {"c", "colours confidence"},
                                                                 {"c", "colours error"},
                                                                 {"c", "colours real"},
                                                                 {"f", "view follows the camera"},
                                                                 {"f", "view is free"},
                                                                 {"b", "view from behind"},
                                                                 {"o", "view from above"},
                                                                 {"g", "background off"},
                                                                 {"k", "boxes on"},
                                                                 {"t", "path off"},
                                                                 {"Tab", "object 2"},
                                                                 {"s", "slices on of object 2"},
                                                                 {"y", "slices across y on"},
                                                                 {"Up", "slices across y at 52 %"},
                                                                 {"Down", "slices across y at 50 %"},
                                                                 {"y", "slices across y off"},
                                                                 {"h", "help on"},
                                                                 {"h", "help off"}};
  for (const auto& [key, said] : keys)
    expectAfter (key, said, *run);
  press ("w"); // means something to VTK, not here
  press ("q");
  EXPECT_EQ (run->wait (), 0) << run->errors ();
  EXPECT_EQ (snapshot ("out"), before);
}

TEST_F (ViewerWindow, ItPlaysAndStops)
{
  const auto run = open ();
  expectAfter ("space", "play", *run);
  EXPECT_TRUE (run->waitForError ("frame 12 of 12")) << run->errors ();
  EXPECT_TRUE (run->waitForError ("play paused")); // at the end
  for (int frame = 2; frame <= 12; ++frame)
    EXPECT_NE (run->errors ().find ("frame " + std::to_string (frame) + " of 12"), std::string::npos);
  press ("Escape");
  EXPECT_EQ (run->wait (), 0) << run->errors ();
}

TEST_F (ViewerWindow, TheSliderLeadsToAFrame)
{
  const auto run = open ();
  // The bar goes from 0.03 to 0.97 of the width, 0.045 of the height above the lower edge.
  const auto click = [&] (double share) {
    const int x = static_cast<int> (400 * (0.03 + 0.94 * share)), y = static_cast<int> (300 * (1.0 - 0.045));
    display_.act ({"mousemove", "--window", window_, std::to_string (x), std::to_string (y), "click", "1"});
  };
  click (0.5);
  EXPECT_TRUE (run->waitForError ("frame 7 of 12") || run->errors ().find ("frame 6 of 12") != std::string::npos)
      << run->errors ();
  click (1.0);
  EXPECT_TRUE (run->waitForError ("frame 12 of 12")) << run->errors ();
  // A drag on the scene turns it, without a jump to another frame, and lets go of the camera.
  expectAfter ("f", "view follows the camera", *run);
  display_.act ({"mousemove", "--window", window_, "200", "100", "mousedown", "1", "mousemove", "--window", window_,
                 "240", "120", "mouseup", "1"});
  EXPECT_TRUE (run->waitForError ("view is free")) << run->errors ();
  press ("q");
  EXPECT_EQ (run->wait (), 0) << run->errors ();
}

TEST_F (ViewerWindow, ViewpointAndPictureAreSaved)
{
  const auto run = open ({"--colour", "instance", "--triangles", "0", "--hide", "caption", "--hide", "legend"});
  expectAfter ("End", "frame 12 of 12", *run);
  press ("v");
  ASSERT_TRUE (appears ("viewpoint.json"));
  std::this_thread::sleep_for (std::chrono::seconds (5)); // messages are gone then
  press ("p");
  ASSERT_TRUE (appears ("window_0001.png"));
  press ("b");
  press ("l");
  EXPECT_TRUE (run->waitForError ("view of viewpoint.json")) << run->errors ();
  expectAfter ("f", "view follows the camera", *run);
  std::this_thread::sleep_for (std::chrono::seconds (5));
  press ("p");
  ASSERT_TRUE (appears ("window_0002.png"));
  press ("q");
  EXPECT_EQ (run->wait (), 0) << run->errors ();
  EXPECT_NE (run->output ().find ("wrote viewpoint.json"), std::string::npos);

  // What the rasteriser draws is the same, but for edges.
  const Words plain = {"--colour", "instance", "--size", "400x300",     "--hide",
                       "caption",  "--hide",   "legend", "--screenshot"};
  const auto draw = [&] (const Words& more) {
    Words words = plain;
    words.insert (words.end (), more.begin (), more.end ());
    ASSERT_EQ (view (words), 0) << errors_;
  };
  draw ({"free.png", "--viewpoint", "viewpoint.json", "out"});
  draw ({"follow.png", "--view", "camera", "out"});
  EXPECT_LT (differingShare (loadColourImage (file ("window_0001.png")), loadColourImage (file ("free.png"))), 0.02);
  EXPECT_LT (differingShare (loadColourImage (file ("window_0002.png")), loadColourImage (file ("follow.png"))), 0.02);
  EXPECT_GT (differingShare (loadColourImage (file ("window_0001.png")), loadColourImage (file ("window_0002.png"))),
             0.1);
}

TEST_F (ViewerWindow, NothingIsSavedInTheRunsFolder)
{
  const auto before = snapshot ("out");
  ToolRun run ({"--verbose", "--size", "400x300", "--viewpoint", "../view.json", "."}, file ("out"),
               display_.asDisplay (), PCL_COSECTION_VIEWER);
  EXPECT_EQ (run.wait (), 1); // there is no such viewpoint
  ToolRun inside ({"--verbose", "--size", "400x300", "."}, file ("out"), display_.asDisplay (), PCL_COSECTION_VIEWER);
  EXPECT_TRUE (inside.waitForError ("h: help"));
  window_ = display_.window ("pcl_cosection_viewer: .");
  press ("v");
  EXPECT_TRUE (inside.waitForError ("the viewpoint is not saved"));
  press ("p");
  EXPECT_TRUE (inside.waitForError ("no picture is saved"));
  press ("q");
  EXPECT_EQ (inside.wait (), 0);
  auto after = snapshot ("out");
  after.erase ("tool_stdout.txt"); // of this test
  after.erase ("tool_stderr.txt");
  EXPECT_EQ (after, before);
}

TEST_F (ViewerWindow, LiveChangesNothing)
{
  ToolRun run (known ({"--live", "sim", "watched"}), file (""), display_.asDisplay (), PCL_COSECTION_FUSION);
  window_ = display_.window ("pcl_cosection_viewer: watched");
  ASSERT_NE (window_, "");
  EXPECT_EQ (run.wait (), 0) << run.errors ();
  for (const std::string& name : filesIn ("out"))
  {
    if (name == "summary.json") // has times
      continue;
    EXPECT_EQ (readFile (file ("watched/" + name)), readFile (file ("out/" + name))) << name;
  }
  EXPECT_EQ (filesIn ("watched"), filesIn ("out"));
  // The window stays and shows the result.
  std::this_thread::sleep_for (std::chrono::seconds (3));
  press ("End");
  press ("b");
  press ("p");
  ASSERT_TRUE (appears ("window_0001.png"));
  std::this_thread::sleep_for (std::chrono::seconds (1));
  const Picture picture = loadColourImage (file ("window_0001.png"));
  const std::set<std::array<std::uint8_t, 3>> colours (picture.pixels.begin (), picture.pixels.end ());
  EXPECT_GT (colours.size (), 300u);
  press ("q");
  for (int n = 0; n < 100 && !display_.act ({"search", "--name", "pcl_cosection_viewer: watched"}).empty (); ++n)
    std::this_thread::sleep_for (std::chrono::milliseconds (100));
  EXPECT_EQ (display_.act ({"search", "--name", "pcl_cosection_viewer: watched"}), "");
}

TEST_F (ViewerWindow, TheRunOutlivesItsWindow)
{
  ToolRun run (known ({"--live", "sim", "watched"}), file (""), display_.asDisplay (), PCL_COSECTION_FUSION);
  window_ = display_.window ("pcl_cosection_viewer: watched");
  ASSERT_NE (window_, "");
  press ("q");
  EXPECT_EQ (run.wait (), 0) << run.errors ();
  EXPECT_EQ (filesIn ("watched"), filesIn ("out"));
  EXPECT_EQ (readFile (file ("watched/mesh/object_1.ply")), readFile (file ("out/mesh/object_1.ply")));
}

TEST_F (ViewerWindow, LiveWithoutDisplayDoesNotBegin)
{
  const auto before = snapshot ("out");
  EXPECT_EQ (run (known ({"--live", "sim", "out"}), [] { unsetenv ("DISPLAY"); }), 1);
  EXPECT_EQ (errors_,
             "pcl_cosection_fusion: error: --live: no window can be opened: there is no display, DISPLAY is not set\n");
  EXPECT_EQ (snapshot ("out"), before); // what an earlier run wrote is still there
}

#endif
