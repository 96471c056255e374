// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "simulate_command_line.h"

#include "frame_span.h"
#include "option_values.h"
#include "suggestion.h"

#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

std::vector<std::string>
presetNames ()
{
  std::vector<std::string> names;
  for (const ScenePreset& preset : scenePresets ())
    names.push_back (preset.name);
  return (names);
}

void
requirePreset (const std::string& option, const std::string& name)
{
  const std::vector<std::string> names = presetNames ();
  if (std::find (names.begin (), names.end (), name) == names.end ())
    throw UsageError (option + ": there is no preset " + name + suggestion (name, names) +
                      "; --list-presets names them");
}

void
setPaths (const GivenSimulation& given, SimulateSettings& settings)
{
  const std::size_t needed = given.preset.empty () ? 2 : 1;
  if (given.paths.size () < needed)
    throw UsageError (given.paths.empty () && given.preset.empty ()
                          ? "SPEC.json and OUTPUT are missing; see --help"
                          : "OUTPUT is missing" +
                                (given.preset.empty () ? " after " + given.paths[0] : std::string ()) + "; see --help");
  if (given.paths.size () > needed)
    throw UsageError ("there is one argument too many: " + given.paths[needed] +
                      (given.preset.empty () ? "" : "; with --preset there is no SPEC.json"));
  if (given.preset.empty ())
    settings.spec = given.paths[0];
  settings.output = given.paths.back ();
  if (settings.output.empty ())
    throw UsageError ("OUTPUT is empty; it must be the name of a new folder");
}

} // namespace

const ProgramText&
simulationText ()
{
  static const ProgramText text = {
      "pcl_cosection_simulate",
      "render known scenes as an RGB-D camera sees them, with the truth",
      "pcl_cosection_simulate [OPTIONS] SPEC.json OUTPUT\n       pcl_cosection_simulate [OPTIONS] --preset NAME OUTPUT",
      "Renders a known scene as an RGB-D camera sees it: colour, depth, masks, point clouds, and the truth to compare "
      "with.",
      {"SPEC.json describes the scene: shapes or mesh files, how they and the camera move, the camera and its noise; "
       "--print-preset shows one, doc/pcl_cosection_simulate.md explains each field.",
       "OUTPUT is a new folder: colour/, depth_noise/ or depth/, mask/, views/ (labelled PCD files), gt-cam-0.txt, "
       "gt-NAME-ID.txt, gt-mesh/, calibration.txt, scene.json."},
      {
          {"pcl_cosection_simulate --preset table table", "things on a table, 81 frames, with their truth"},
          {"pcl_cosection_simulate --preset toys --frames 0:50 --seed 7 toys",
           "a part of a sequence, with other noise"},
          {"pcl_cosection_simulate --preset stack --no-noise --views-every 10 stack",
           "exact depth, and a point cloud of every tenth frame"},
          {"pcl_cosection_simulate mine.json mine", "a scene of your own"},
      },
      {"preset = table", "views-every = 5"},
  };
  return (text);
}

void
declareSimulationOptions (CLI::App& app, GivenSimulation& given)
{
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  const std::string scene = "Scene";
  app.add_option ("--preset", given.preset, "A scene that comes with the program")->option_text ("NAME")->group (scene);
  app.add_flag ("--list-presets", given.list_presets, "Name them")->group (scene)->configurable (false);
  app.add_option ("--print-preset", given.print_preset, "Print one's description, to begin your own with")
      ->option_text ("NAME")
      ->group (scene)
      ->configurable (false);
  const std::string output = "Output";
  app.add_option ("--frames", given.frames, "Only the frames from A up to but without B (default: all)")
      ->option_text ("A:B")
      ->group (output);
  app.add_option ("--seed", given.seed, "Of the noise (default: the scene's)")
      ->option_text ("N")
      ->check (wholeRange (0, 2147483647))
      ->group (output);
  app.add_flag ("--no-noise", given.no_noise, "Exact depth, in depth/")->group (output);
  app.add_option ("--views-every", given.views_every,
                  "A labelled point cloud of every N-th frame; 0 for none (default: the scene's)")
      ->option_text ("N")
      ->check (wholeRange (0, 1000000))
      ->group (output);
  app.add_option ("--json", given.json, "Write a summary for programs")->option_text ("FILE")->group (output);
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_simulate", given.verbose, given.quiet);
}

std::optional<SimulateSettings>
parseSimulateCommandLine (int argc, const char* const* argv)
{
  GivenSimulation given;
  CLI::App app;
  declareSimulationOptions (app, given);
  if (!parseArguments (app, simulationText (), argc, argv))
    return (std::nullopt);
  SimulateSettings settings;
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  settings.list_presets = given.list_presets;
  settings.print_preset = given.print_preset;
  if (!given.print_preset.empty ())
    requirePreset ("--print-preset", given.print_preset);
  if (!given.preset.empty ())
    requirePreset ("--preset", given.preset);
  if (given.list_presets || !given.print_preset.empty ())
    return (settings);
  settings.preset = given.preset;
  setPaths (given, settings);
  if (!given.frames.empty ())
  {
    const FrameSpan frames = parseFrames (given.frames);
    settings.first_frame = static_cast<int> (frames.first);
    settings.last_frame = frames.last ? static_cast<int> (*frames.last) : -1;
  }
  settings.seed = given.seed;
  settings.views_every = given.views_every;
  settings.no_noise = given.no_noise;
  settings.json = given.json;
  settings.threads = given.threads.value_or (0);
  return (settings);
}
