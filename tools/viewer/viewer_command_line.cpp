// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "viewer_command_line.h"

#include "option_values.h"

#include "pcl_cosection/visualization/scene_caption.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
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
declareWhat (CLI::App& app, GivenViewer& given)
{
  const std::string group = "What";
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  app.add_option (
         "--mode", given.mode,
         "The completed meshes, what was seen of the objects, or the readings of the frame (default: completed)")
      ->option_text (joined (surfaceNames ()))
      ->check (oneOf (surfaceNames ()))
      ->group (group);
  app.add_option ("--colour", given.colour,
                  "Real colours, one for each object, why a surface is where it is, how near a reading is, or the "
                  "distance to the "
                  "truth (default: real)")
      ->option_text (joined (colourNames ()))
      ->check (oneOf (colourNames ()))
      ->group (group);
  app.add_option ("--truth", given.truth, "Dataset with the truth, for --colour error")
      ->option_text ("DATASET")
      ->group (group);
  app.add_option ("--dataset", given.dataset, "Images for --mode points (default: those that the run has read)")
      ->option_text ("DATASET")
      ->group (group);
  app.add_option ("--frame", given.frame,
                  "The stamp to show, or to begin with (default: the last; in a window, the first)")
      ->option_text ("STAMP")
      ->check (numberRange (-unlimited, unlimited))
      ->group (group);
  app.add_option ("--hide", given.hidden, "Leave something out; repeatable")
      ->option_text (joined (parts))
      ->allow_extra_args (false)
      ->check (oneOf (parts))
      ->group (group);
  app.add_flag ("--boxes", given.boxes, "Show the bounding volumes of the objects")->group (group);
}

void
declareView (CLI::App& app, GivenViewer& given)
{
  const std::string group = "View";
  app.add_option ("--view", given.view,
                  "From above and behind the cameras, from the other side, which the cameras did not see, or with the "
                  "camera of the run "
                  "(default: overview)")
      ->option_text (joined (view_names))
      ->check (oneOf (view_names))
      ->group (group);
  app.add_option ("--viewpoint", given.viewpoint, "A viewpoint that was saved in the window, instead")
      ->option_text ("FILE")
      ->group (group);
  app.add_option ("--size", given.size, "Of the picture or the window, pixels (default: 1280x720)")
      ->option_text ("WxH")
      ->group (group);
  app.add_option ("--triangles", given.triangles,
                  "Draw the background with at most so many triangles and each object with half as many; 0: with all "
                  "(default: 30000 in a window, for "
                  "speed; all in pictures)")
      ->option_text ("N")
      ->check (wholeRange (0, most_triangles))
      ->group (group);
}

void
declareOutput (CLI::App& app, GivenViewer& given)
{
  const std::string group = "Output";
  app.add_option ("--screenshot", given.screenshot, "Write a picture instead of opening a window; no display is needed")
      ->option_text ("FILE.png")
      ->group (group);
  app.add_option ("--record", given.record,
                  "Write a picture of every frame, Frame00001.png and so on; no display is needed")
      ->option_text ("DIR")
      ->group (group);
  app.add_option ("--every", given.every, "Record every N-th frame only (default: 1)")
      ->option_text ("N")
      ->check (wholeRange (1, 1000000))
      ->group (group);
  app.add_option ("--follow", given.follow,
                  "Show the snapshots that are written to this folder, until standard input ends, and OUTPUT then; "
                  "pcl_cosection_fusion --live uses it")
      ->option_text ("DIR")
      ->group (group);
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_viewer", given.verbose, given.quiet);
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

bool
isPng (const std::string& path)
{
  const std::string ending = ".png";
  return (path.size () > ending.size () && path.compare (path.size () - ending.size (), ending.size (), ending) == 0);
}

void
setPaths (const GivenViewer& given, ViewerSettings& settings)
{
  if (given.paths.empty ())
    throw UsageError ("OUTPUT is missing: the folder that pcl_cosection_fusion wrote; see --help");
  if (given.paths.size () > 1)
    throw UsageError ("there is one argument too many: " + given.paths[1]);
  settings.run = given.paths[0];
  if (settings.run.empty ())
    throw UsageError ("OUTPUT is empty; it must be a folder");
  settings.screenshot = given.screenshot;
  settings.record = given.record;
  settings.follow = given.follow;
  if (!settings.screenshot.empty () && !isPng (settings.screenshot))
    throw UsageError ("--screenshot " + settings.screenshot + ": must end in .png");
  if (given.every && settings.record.empty ())
    throw UsageError ("--every needs --record");
  if (!settings.follow.empty () && !settings.needsWindow ())
    throw UsageError ("--follow needs a window: it excludes --screenshot and --record");
  if (!settings.screenshot.empty () && !settings.record.empty ())
    throw UsageError ("--screenshot and --record exclude each other");
}

ViewerSettings
toSettings (const GivenViewer& given)
{
  ViewerSettings settings;
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  setPaths (given, settings);
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  settings.truth = given.truth;
  settings.dataset = given.dataset;
  settings.viewpoint = given.viewpoint;
  settings.choice = modeOf (given.view, view_names, ViewChoice::Overview);
  if (!given.view.empty () && !given.viewpoint.empty ())
    throw UsageError ("--view and --viewpoint exclude each other");
  settings.stamp = given.frame;
  if (given.frame && !settings.record.empty ())
    throw UsageError ("--frame and --record exclude each other: every frame is recorded");
  settings.triangles = static_cast<std::size_t> (
      given.triangles.value_or (settings.needsWindow () ? window_triangles : 0));
  settings.every = static_cast<std::size_t> (given.every.value_or (1));
  settings.threads = given.threads.value_or (0);
  SceneView& view = settings.view;
  setSize (given.size, view);
  view.surface = modeOf (given.mode, surfaceNames (), SurfaceMode::Completed);
  view.colour = modeOf (given.colour, colourNames (), ColourMode::Real);
  if (view.colour == ColourMode::Error && settings.truth.empty ())
    throw UsageError ("--colour error needs the truth: --truth DATASET");
  view.boxes = given.boxes;
  const std::vector<bool*> shown = {&view.objects, &view.background, &view.path,
                                    &view.frustum, &view.legend,     &view.caption};
  for (const std::string& word : given.hidden)
    *shown[static_cast<std::size_t> (std::find (parts.begin (), parts.end (), word) - parts.begin ())] = false;
  view.validate ();
  return (settings);
}

} // namespace

const ProgramText&
viewerText ()
{
  static const ProgramText text = {
      "pcl_cosection_viewer",
      "look at what pcl_cosection_fusion made of a sequence",
      "pcl_cosection_viewer [OPTIONS] OUTPUT",
      "Shows the background and the objects of a run along their trajectories: in a window, or as pictures where there "
      "is no display.",
      {"OUTPUT is the folder that pcl_cosection_fusion wrote. It is only read.",
       "In the window, the key h shows all keys: space plays, the arrows step, m and c change surfaces and colours, f "
       "follows the camera, "
       "v saves the viewpoint."},
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
declareViewerOptions (CLI::App& app, GivenViewer& given)
{
  declareWhat (app, given);
  declareView (app, given);
  declareOutput (app, given);
}

std::optional<ViewerSettings>
parseViewerCommandLine (int argc, const char* const* argv)
{
  GivenViewer given;
  CLI::App app;
  declareViewerOptions (app, given);
  if (!parseArguments (app, viewerText (), argc, argv))
    return (std::nullopt);
  try
  {
    return (toSettings (given));
  }
  catch (const InvalidArgument& error)
  {
    throw UsageError (error.what ());
  }
}
