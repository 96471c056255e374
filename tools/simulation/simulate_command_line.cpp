// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "simulate_command_line.h"

#include "option_values.h"

#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

void
requirePreset (const std::string& option, const std::string& name)
{
  std::vector<std::string> names;
  for (const ScenePreset& preset : scenePresets ())
    names.push_back (preset.name);
  if (!name.empty () && std::find (names.begin (), names.end (), name) == names.end ())
    throw UsageError (option + ": there is no preset " + name + suggestion (name, names) +
                      "; --list-presets names them");
}

void
setPaths (SimulateSettings& settings)
{
  const std::vector<std::string>& paths = settings.paths;
  const bool has_preset = !settings.preset.empty () || !settings.meshes.empty ();
  const std::size_t needed = has_preset ? 1 : 2;
  if (paths.size () < needed)
    throw UsageError (paths.empty () && !has_preset
                          ? "SPEC.json and OUTPUT are missing; see --help"
                          : "OUTPUT is missing" + (has_preset ? "" : " after " + paths[0]) + "; see --help");
  if (paths.size () > needed)
    throw UsageError ("there is one argument too many: " + paths[needed] +
                      (has_preset ? "; with --preset and --meshes there is no SPEC.json" : ""));
  if (!has_preset)
    settings.spec = paths[0];
  settings.output = paths.back ();
  if (settings.output.empty ())
    throw UsageError ("OUTPUT is empty; it must be the name of a new folder");
}

void
interpretMeshes (SimulateSettings& settings)
{
  if (settings.meshes.empty ())
  {
    const TableSceneOptions usual, &table = settings.table;
    const std::vector<std::pair<bool, const char*>> without_effect = {
        {table.scenes != usual.scenes, "--scenes"},
        {table.per_scene != usual.per_scene, "--per-scene"},
        {table.views != usual.views, "--views"},
        {table.camera_height_m != usual.camera_height_m, "--camera-height"},
        {table.camera_distance_m != usual.camera_distance_m, "--camera-distance"},
        {table.mask_dilation_px != usual.mask_dilation_px, "--mask-dilation"},
        {table.mask_shift_px != usual.mask_shift_px, "--mask-shift"},
        {table.occluders != usual.occluders, "--occluders"}};
    for (const auto& [is_given, option] : without_effect)
      if (is_given)
        throw UsageError (std::string (option) + " has an effect with --meshes alone");
    return;
  }
  if (!settings.preset.empty () || !settings.frames.empty () || settings.views_every)
    throw UsageError ("--meshes excludes --preset, --frames and --views-every");
  settings.table.noise = !settings.no_noise;
  settings.table.seed = static_cast<std::uint64_t> (settings.seed.value_or (1));
}

void
interpret (SimulateSettings& settings)
{
  requirePreset ("--print-preset", settings.print_preset);
  requirePreset ("--preset", settings.preset);
  if (settings.list_presets || !settings.print_preset.empty ())
    return;
  setPaths (settings);
  interpretMeshes (settings);
  if (settings.frames.empty ())
    return;
  const FrameSpan frames = parseFrames (settings.frames);
  settings.first_frame = static_cast<int> (frames.first);
  settings.last_frame = frames.last ? static_cast<int> (*frames.last) : -1;
}

} // namespace

const ProgramText&
simulationText ()
{
  static const ProgramText text = {
      "pcl_cosection_simulate",
      "render known scenes as an RGB-D camera sees them, with the truth",
      "pcl_cosection_simulate [OPTIONS] SPEC.json OUTPUT\n       pcl_cosection_simulate [OPTIONS] --preset NAME "
      "OUTPUT\n"
      "       pcl_cosection_simulate [OPTIONS] --meshes FOLDER OUTPUT",
      "Renders a known scene as an RGB-D camera sees it: colour, depth, masks, point clouds, and the truth to compare "
      "with.",
      {"SPEC.json describes the scene: shapes or mesh files, how they and the camera move, the camera and its noise; "
       "--print-preset shows one, doc/pcl_cosection_simulate.md explains each field.",
       "OUTPUT is a new folder: colour/, depth_noise/ or depth/, mask/, views/ (labelled PCD files), gt-cam-0.txt, "
       "gt-NAME-ID.txt, gt-mesh/, calibration.txt, scene.json.",
       "With --meshes, the things of a folder stand on a table, in random places; OUTPUT has a folder per scene with "
       "labelled views (viewN.pcd), the true meshes (truth_LABEL.ply) and their names (names.txt), for "
       "pcl_cosection_evaluate views."},
      {
          {"pcl_cosection_simulate --preset table table", "things on a table, 81 frames, with their truth"},
          {"pcl_cosection_simulate --preset toys --frames 0:50 --seed 7 toys",
           "a part of a sequence, with other noise"},
          {"pcl_cosection_simulate --preset stack --no-noise --views-every 10 stack",
           "exact depth, and a point cloud of every tenth frame"},
          {"pcl_cosection_simulate mine.json mine", "a scene of your own"},
          {"pcl_cosection_simulate --meshes things --per-scene 6 --views 3 scenes",
           "your own things, six on each table, seen from three sides"},
      },
      {"preset = table", "views-every = 5"},
  };
  return (text);
}

void
declareSimulationOptions (CLI::App& app, SimulateSettings& settings)
{
  OptionGroup scene (app, "Scene"), meshes (app, "Meshes"), output (app, "Output");
  scene.add ("--preset NAME", settings.preset, "A scene that comes with the program");
  scene.addFlag ("--list-presets", settings.list_presets, "Name them")->configurable (false);
  scene.add ("--print-preset NAME", settings.print_preset, "Print one's description, to begin your own with")
      ->configurable (false);
  TableSceneOptions& table = settings.table;
  meshes.add ("--meshes FOLDER", settings.meshes,
              "Scenes of its meshes (.ply, .obj, .stl, .off, .vtk, .vtp; metres, z upwards) on a table");
  meshes.add ("--scenes N", table.scenes, wholeRange (0, 100000), "How many (default: as many as show each mesh once)");
  meshes.add ("--per-scene N", table.per_scene, wholeRange (1, 1000),
              "Things on a table" + byDefault (table.per_scene));
  meshes.add ("--views N", table.views, wholeRange (1, 1000), "Views, all around" + byDefault (table.views));
  meshes.add ("--camera-height METRES", table.camera_height_m, positiveNumber (),
              "Of the cameras over the table" + byDefault (table.camera_height_m));
  meshes.add ("--camera-distance METRES", table.camera_distance_m, numberRange (0, 100),
              "Of the cameras from its middle, sideways; 0: straight above" + byDefault (table.camera_distance_m));
  meshes.add ("--mask-dilation PIXELS", table.mask_dilation_px, wholeRange (-100, 100),
              "Labels grow, or shrink, by so much" + byDefault (table.mask_dilation_px));
  meshes.add ("--mask-shift PIXELS", table.mask_shift_px, wholeRange (-100, 100),
              "Labels are so much too far to the right" + byDefault (table.mask_shift_px));
  meshes.add ("--occluders N", table.occluders, wholeRange (0, 100),
              "Posts without a label between the first camera and the things" + byDefault (table.occluders));
  output.add ("--frames A:B", settings.frames, "Only the frames from A up to but without B (default: all)");
  output.add ("--seed N", settings.seed, wholeRange (0, 2147483647),
              "Of the noise, and of places on a table (default: the scene's)");
  output.addFlag ("--no-noise", settings.no_noise, "Exact depth, in depth/");
  output.add ("--views-every N", settings.views_every, wholeRange (0, 1000000),
              "A labelled point cloud of every N-th frame; 0 for none (default: the scene's)");
  output.add ("--json FILE", settings.json, "Write a summary for programs");
  declareGeneralOptions (app, "pcl_cosection_simulate", settings);
}

std::optional<SimulateSettings>
parseSimulateCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<SimulateSettings> (argc, argv, simulationText (), declareSimulationOptions, interpret));
}
