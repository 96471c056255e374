// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Renders known scenes, with the truth; see pcl_cosection_simulate --help.

#include "output_files.h"
#include "run_program.h"
#include "simulate_command_line.h"

#include "pcl_cosection/simulation/penetration_check.h"
#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <nlohmann/json.hpp>
#include <pcl/common/time.h>

#include <algorithm>
#include <iostream>
#include <sstream>

using namespace pcl::cosection;

namespace {

const ScenePreset&
presetOf (const std::string& name)
{
  return (*std::find_if (scenePresets ().begin (), scenePresets ().end (),
                         [&name] (const ScenePreset& preset) { return (preset.name == name); }));
}

SimulatedScene
sceneOf (const SimulateSettings& settings)
{
  SimulatedScene scene = settings.preset.empty () ? loadSceneSpec (settings.spec)
                                                  : parseSceneSpec (presetOf (settings.preset).spec, settings.preset);
  if (settings.seed)
    scene.seed = static_cast<std::uint64_t> (*settings.seed);
  if (settings.views_every)
    scene.views_every = *settings.views_every;
  if (settings.no_noise)
    scene.noise.reset ();
  return (scene);
}

std::vector<std::string>
warningsOf (const SimulatedScene& scene, const SequenceOptions& frames, const ProgressCallback& progress)
{
  PenetrationCheckOptions options;
  options.first = frames.first;
  options.last = frames.last;
  options.threads = frames.threads;
  std::vector<std::string> warnings;
  for (const ScenePenetration& p : findPenetrations (scene, options, progress))
  {
    std::ostringstream text;
    text.precision (2);
    text << p.second << " is inside " << p.first << ", by " << 1000.0 * p.depth_m << " mm at frame " << p.frame
         << " (in " << counted (p.frames, "frame") << ")";
    warnings.push_back (text.str ());
  }
  return (warnings);
}

/** \brief Neither the description nor a mesh may be replaced by the summary, and that must be possible to write. */
void
checkOutputs (const SimulateSettings& settings, const SimulatedScene& scene)
{
  if (settings.json.empty ())
    return;
  std::vector<std::string> inputs{configurationFile (settings.arguments)};
  if (!settings.spec.empty ())
    inputs.push_back (settings.spec);
  for (const SceneBody& body : scene.bodies)
    for (const BodyPart& part : body.parts)
      if (!part.file.empty ())
        inputs.push_back (part.file);
  refuseToOverwrite (inputs, {settings.json});
  requireWritable (settings.json);
}

void
simulate (const SimulateSettings& settings, Terminal& terminal)
{
  const pcl::StopWatch stopwatch;
  const SimulatedScene scene = sceneOf (settings);
  const double read_s = stopwatch.getTimeSeconds ();
  checkOutputs (settings, scene);
  SequenceOptions options;
  options.first = settings.first_frame;
  options.last = settings.last_frame;
  options.threads = settings.threads;
  const auto report = [&] (const std::string& stage, double fraction) {
    terminal.progress (stage, fraction);
    return (!interrupted ());
  };
  const std::vector<std::string> warnings = warningsOf (scene, options, report);
  for (const std::string& warning : warnings)
    terminal.warning (warning);
  const double check_s = stopwatch.getTimeSeconds () - read_s;

  double truth_s = 0.0; // until the first frame
  writeSequence (scene, settings.output, options, [&] (const std::string& stage, double fraction) {
    if (stage == "frames" && truth_s == 0.0)
      truth_s = stopwatch.getTimeSeconds () - read_s - check_s;
    return (report (stage, fraction));
  });
  const double total_s = stopwatch.getTimeSeconds ();
  const int frames = (options.last < 0 ? scene.frames : options.last) - options.first;
  const double render_s = total_s - read_s - check_s - truth_s;
  std::ostringstream text;
  text.precision (3);
  text << "wrote " << settings.output << ": " << counted (frames, "frame") << " of " << scene.camera.width << " x "
       << scene.camera.height << ", " << counted (scene.bodies.size () - 1, "object") << ", " << frames / render_s
       << " frames/s";
  terminal.result (text.str ());
  if (settings.json.empty ())
    return;
  nlohmann::ordered_json summary;
  summary["timings_s"] = {
      {"read", read_s}, {"check", check_s}, {"truth", truth_s}, {"render", render_s}, {"total", total_s}};
  summary["frames"] = frames;
  summary["frames_per_second"] = frames / render_s;
  summary["parameters"] = {
      {"spec", settings.spec},       {"preset", settings.preset},        {"seed", scene.seed},
      {"noise", !!scene.noise},      {"views_every", scene.views_every}, {"threads", settings.threads},
      {"first_frame", options.first}};
  summary["objects"] = nlohmann::ordered_json::array ();
  for (const SceneBody& body : scene.bodies)
    if (body.id > 0)
      summary["objects"].push_back ({{"id", body.id}, {"name", body.name}});
  summary["warnings"] = warnings;
  saveJson (summary, settings.json);
}

void
simulateTables (const SimulateSettings& settings, Terminal& terminal)
{
  const pcl::StopWatch stopwatch;
  if (!settings.json.empty ())
    requireWritable (settings.json);
  std::vector<std::string> warnings;
  const int scenes = writeTableScenes (settings.meshes, settings.output, settings.table, warnings,
                                       [&] (const std::string& stage, double fraction) {
                                         terminal.progress (stage, fraction);
                                         return (!interrupted ());
                                       });
  for (const std::string& warning : warnings)
    terminal.warning (warning);
  const TableSceneOptions& table = settings.table;
  terminal.result ("wrote " + settings.output + ": " + counted (static_cast<std::size_t> (scenes), "scene") + " of " +
                   counted (static_cast<std::size_t> (table.per_scene), "object") + " in " +
                   counted (static_cast<std::size_t> (table.views), "view"));
  if (settings.json.empty ())
    return;
  nlohmann::ordered_json summary;
  summary["timings_s"] = {{"total", stopwatch.getTimeSeconds ()}};
  summary["scenes"] = scenes;
  summary["parameters"] = {{"meshes", settings.meshes},
                           {"per_scene", table.per_scene},
                           {"views", table.views},
                           {"seed", table.seed},
                           {"noise", table.noise},
                           {"camera_height_m", table.camera_height_m},
                           {"camera_distance_m", table.camera_distance_m},
                           {"mask_dilation_px", table.mask_dilation_px},
                           {"mask_shift_px", table.mask_shift_px},
                           {"occluders", table.occluders}};
  summary["warnings"] = warnings;
  saveJson (summary, settings.json);
}

bool
run (const SimulateSettings& settings, Terminal& terminal)
{
  if (settings.list_presets)
    for (const ScenePreset& preset : scenePresets ())
      std::cout << preset.name << std::string (8 - std::min<std::size_t> (7, preset.name.size ()), ' ')
                << preset.meaning << "\n";
  else if (!settings.print_preset.empty ())
    std::cout << presetOf (settings.print_preset).spec;
  else
  {
    catchInterruptions ();
    (settings.meshes.empty () ? simulate : simulateTables) (settings, terminal);
  }
  return (true);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_simulate", "interrupted, nothing was written"}, argc, argv,
                      parseSimulateCommandLine, run));
}
