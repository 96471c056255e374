// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "viewer_command_line.h"

#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/visualization/scene_legend.h"

#include <algorithm>
#include <cstdio>

using namespace pcl::cosection;

namespace {

const std::vector<std::string> view_names = {"overview", "behind", "camera"};
const std::vector<std::string> parts = {"objects", "background", "path", "frustum", "legend", "caption"};
constexpr long most_triangles = 100000000;
constexpr int window_triangles = 30000;

std::string
joined (const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty () ? "" : "|") + word;
  return (text);
}

template <typename Mode>
Mode
modeOf (const std::string& word, const std::vector<std::string>& words, Mode otherwise)
{
  const auto found = std::find (words.begin (), words.end (), word);
  return (word.empty () ? otherwise : static_cast<Mode> (found - words.begin ()));
}

void
declareWhat (CLI::App& app, ViewerSettings& settings)
{
  OptionGroup what (app, "What");
  what.add ("--mode " + joined (surfaceNames ()), settings.mode,
            "The completed meshes, what was seen of the objects, or the readings of the frame (default: completed)");
  what.add ("--colour " + joined (colourNames ()), settings.colour,
            "Real colours, one for each object, why a surface is where it is, how near a reading is, or the distance "
            "to the truth (default: real)");
  what.add ("--truth DATASET", settings.truth, "Dataset with the truth, for --colour error");
  what.add ("--dataset DATASET", settings.dataset, "Images for --mode points (default: those that the run has read)");
  what.add ("--frame STAMP", settings.stamp, numberRange (-unlimited, unlimited),
            "The stamp to show, or to begin with (default: the last; in a window, the first)");
  what.add ("--hide " + joined (parts), settings.hidden, "Leave something out; repeatable");
  what.addFlag ("--boxes", settings.view.boxes, "Show the bounding volumes of the objects");
}

void
declareView (CLI::App& app, ViewerSettings& settings)
{
  OptionGroup view (app, "View");
  view.add ("--view " + joined (view_names), settings.choice_name,
            "From above and behind the cameras, from the other side, which the cameras did not see, or with the camera "
            "of the run (default: overview)");
  view.add ("--viewpoint FILE", settings.viewpoint, "A viewpoint that was saved in the window, instead");
  view.add ("--size WxH", settings.size, "Of the picture or the window, pixels (default: 1280x720)");
  view.add ("--triangles N", settings.triangles_given, wholeRange (0, most_triangles),
            "Draw the background with at most so many triangles and each object with half as many; 0: with all "
            "(default: 30000 in a window, for speed; all in pictures)");
}

void
declareOutput (CLI::App& app, ViewerSettings& settings)
{
  OptionGroup output (app, "Output");
  output.add ("--screenshot FILE.png", settings.screenshot,
              "Write a picture instead of opening a window; no display is needed");
  output.add ("--record DIR", settings.record,
              "Write a picture of every frame, Frame00001.png and so on; no display is needed");
  output.add ("--every N", settings.every_given, wholeRange (1, 1000000), "Record every N-th frame only (default: 1)");
  output.add ("--follow DIR", settings.follow,
              "Show the snapshots that are written to this folder, until standard input ends, and OUTPUT then; "
              "pcl_cosection_fusion --live uses it");
}

void
setSize (const std::string& text, SceneView& view)
{
  if (text.empty ())
    return;
  char cross = 0, rest = 0;
  if (std::sscanf (text.c_str (), "%6d%c%6d%c", &view.width, &cross, &view.height, &rest) != 3 || cross != 'x')
    throw UsageError ("--size must be WIDTHxHEIGHT in pixels, such as 1280x720; it is \"" + text + "\"");
}

void
setPaths (ViewerSettings& settings)
{
  if (settings.paths.empty ())
    throw UsageError ("OUTPUT is missing: the folder that pcl_cosection or pcl_cosection_fusion wrote; see --help");
  if (settings.paths.size () > 1)
    throw UsageError ("there is one argument too many: " + settings.paths[1]);
  settings.run = settings.paths[0];
  if (settings.run.empty ())
    throw UsageError ("OUTPUT is empty; it must be a folder");
  if (!settings.screenshot.empty () && !endsWith (settings.screenshot, ".png"))
    throw UsageError ("--screenshot " + settings.screenshot + ": must end in .png");
  if (settings.every_given && settings.record.empty ())
    throw UsageError ("--every needs --record");
  if (!settings.follow.empty () && !settings.needsWindow ())
    throw UsageError ("--follow needs a window: it excludes --screenshot and --record");
  if (!settings.screenshot.empty () && !settings.record.empty ())
    throw UsageError ("--screenshot and --record exclude each other");
}

void
interpret (ViewerSettings& settings)
{
  setPaths (settings);
  settings.choice = modeOf (settings.choice_name, view_names, ViewChoice::Overview);
  if (!settings.choice_name.empty () && !settings.viewpoint.empty ())
    throw UsageError ("--view and --viewpoint exclude each other");
  if (settings.stamp && !settings.record.empty ())
    throw UsageError ("--frame and --record exclude each other: every frame is recorded");
  settings.triangles = static_cast<std::size_t> (
      settings.triangles_given.value_or (settings.needsWindow () ? window_triangles : 0));
  settings.every = static_cast<std::size_t> (settings.every_given.value_or (1));
  SceneView& view = settings.view;
  setSize (settings.size, view);
  view.surface = modeOf (settings.mode, surfaceNames (), SurfaceMode::Completed);
  view.colour = modeOf (settings.colour, colourNames (), ColourMode::Real);
  if (view.colour == ColourMode::Error && settings.truth.empty ())
    throw UsageError ("--colour error needs the truth: --truth DATASET");
  const std::vector<bool*> shown = {&view.objects, &view.background, &view.path,
                                    &view.frustum, &view.legend,     &view.caption};
  for (const std::string& word : settings.hidden)
    *shown[static_cast<std::size_t> (std::find (parts.begin (), parts.end (), word) - parts.begin ())] = false;
  view.validate ();
}

} // namespace

const ProgramText&
viewerText ()
{
  static const ProgramText text = {
      "pcl_cosection_viewer",
      "look at completed objects and at tracked sequences",
      "pcl_cosection_viewer [OPTIONS] OUTPUT",
      "Shows the background and the objects that pcl_cosection completed, or those of a sequence along their "
      "trajectories: in a window, or as pictures where there is no display.",
      {"OUTPUT is the folder that pcl_cosection or pcl_cosection_fusion wrote. It is only read.",
       "In the window, the key h shows all keys: space plays, the arrows step, m and c change surfaces and colours, f "
       "follows the camera, v saves the viewpoint."},
      {
          {"pcl_cosection_viewer out", "a window"},
          {"pcl_cosection_viewer --screenshot scene.png out", "a picture of the last frame, without a display"},
          {"pcl_cosection_viewer --view behind --colour provenance --screenshot a.png out",
           "the surfaces that the camera did not see, and why they are where they are"},
          {"pcl_cosection_viewer --colour error --truth toys --screenshot errors.png out",
           "the distance to the true surfaces"},
          {"pcl_cosection_viewer --record frames --view camera out", "pictures for a film, from where the camera was"},
      },
      {"colour = provenance", "size = 1920x1080"},
  };
  return (text);
}

void
declareViewerOptions (CLI::App& app, ViewerSettings& settings)
{
  declareWhat (app, settings);
  declareView (app, settings);
  declareOutput (app, settings);
  declareGeneralOptions (app, "pcl_cosection_viewer", settings);
}

std::optional<ViewerSettings>
parseViewerCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<ViewerSettings> (argc, argv, viewerText (), declareViewerOptions, interpret));
}
