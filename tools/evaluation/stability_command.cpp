// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stability_command.h"

#include "common_options.h"
#include "evaluation_output.h"
#include "option_values.h"
#include "output_files.h"
#include "scene_stability.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace {

struct StabilitySettings : CommonOptions
{
  double seconds = 5.0;
  double max_drift_m = 0.003;
  double max_turn_deg = 2.0;

  bool stayed (const BodyDrift& body) const { return (body.stayed (max_drift_m, max_turn_deg / degrees_per_rad)); }
};

const ProgramText&
stabilityText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate stability",
      "which bodies of a simulated scene stay where they are",
      "pcl_cosection_evaluate stability [OPTIONS] SCENE",
      "Simulates a scene with MuJoCo and measures how far its bodies move.",
      {"SCENE is a file in MuJoCo's format, or a folder with scene.xml or export/scene.xml. Bodies with a free joint "
       "begin where the file "
       "has them; nothing but gravity and contacts acts on them. A body that is at the end within --max-drift and "
       "--max-turn of its beginning has stayed; one that was ever farther off than ten times the extent of the scene "
       "flew away. A simulation that becomes unstable is an error.",
       "This needs a build with MuJoCo (libmujoco-dev)."},
      {
          {"pcl_cosection_evaluate stability scene", "a line for each body of scene/scene.xml, and a summary"},
          {"pcl_cosection_evaluate stability --seconds 20 --json drift.json scene",
           "four times as long; all numbers for programs"},
      },
      {"seconds = 10", "max-drift = 0.001"},
  };
  return (text);
}

/** \brief What an argument stands for. */
std::string
sceneFile (const std::string& path)
{
  std::error_code unknown;
  const bool is_folder = std::filesystem::is_directory (path, unknown);
  if (!is_folder)
    return (path);
  const std::filesystem::path folder (path);
  const bool is_result = !std::filesystem::exists (folder / "scene.xml", unknown) &&
                         std::filesystem::exists (folder / "export" / "scene.xml", unknown); // by --export
  return ((is_result ? folder / "export" / "scene.xml" : folder / "scene.xml").string ());
}

std::size_t
countStayed (const StabilitySettings& settings, const SceneStability& scene)
{
  return (static_cast<std::size_t> (std::count_if (scene.bodies.begin (), scene.bodies.end (),
                                                   [&] (const BodyDrift& body) { return (settings.stayed (body)); })));
}

std::size_t
countFlown (const SceneStability& scene)
{
  return (static_cast<std::size_t> (std::count_if (scene.bodies.begin (), scene.bodies.end (),
                                                   [] (const BodyDrift& body) { return (body.flew_away); })));
}

double
shareStayed (const StabilitySettings& settings, const SceneStability& scene)
{
  return (static_cast<double> (countStayed (settings, scene)) / static_cast<double> (scene.bodies.size ()));
}

void
print (const StabilitySettings& settings, const SceneStability& scene, Terminal& terminal)
{
  TextTable table ({"body", "drift", "largest", "turn", "largest", "(mm, degrees)"});
  for (const BodyDrift& body : scene.bodies)
    table.add ({body.name, inMillimetres (body.drift_m), inMillimetres (body.largest_drift_m),
                toText (degrees_per_rad * body.turn_rad), toText (degrees_per_rad * body.largest_turn_rad),
                body.flew_away           ? "flew away"
                : settings.stayed (body) ? ""
                                         : "moved"});
  table.print (terminal);
  terminal.result ("");
  if (const auto& contact = scene.deepest_contact)
    terminal.result ("deepest initial contact: " + inMillimetres (contact->depth_m) + " mm, between " + contact->first +
                     " and " + contact->second);
  else
    terminal.result ("no bodies overlap at the start");
  const std::size_t flown = countFlown (scene);
  terminal.result (std::to_string (countStayed (settings, scene)) + " of " +
                   (scene.bodies.size () == 1 ? "1 body" : std::to_string (scene.bodies.size ()) + " bodies") +
                   " stayed (" + inPercent (shareStayed (settings, scene)) + "), within " +
                   toShortText (1000.0 * settings.max_drift_m) + " mm and " + toShortText (settings.max_turn_deg) +
                   " degrees after " + toShortText (scene.duration_s) + " s" +
                   (flown > 0 ? "; " + std::to_string (flown) + " flew away" : ""));
}

Json
stabilityJson (const StabilitySettings& settings, const SceneStability& scene)
{
  Json json;
  json["bodies"] = Json::array ();
  for (const BodyDrift& body : scene.bodies)
    json["bodies"].push_back ({{"name", body.name},
                               {"drift_m", body.drift_m},
                               {"turn_deg", degrees_per_rad * body.turn_rad},
                               {"drift_max_m", body.largest_drift_m},
                               {"turn_max_deg", degrees_per_rad * body.largest_turn_rad},
                               {"flew_away", body.flew_away},
                               {"stayed", settings.stayed (body)}});
  json["deepest_contact"] = Json ();
  if (const auto& contact = scene.deepest_contact)
    json["deepest_contact"] = {
        {"penetration_m", contact->depth_m}, {"first", contact->first}, {"second", contact->second}};
  json["summary"] = {{"bodies", scene.bodies.size ()},
                     {"stayed", countStayed (settings, scene)},
                     {"stayed_share", shareStayed (settings, scene)},
                     {"flew_away", countFlown (scene)}};
  json["extent_m"] = scene.extent_m;
  json["duration_s"] = scene.duration_s;
  json["time_step_s"] = scene.time_step_s;
  json["scene"] = settings.paths[0];
  json["parameters"] = {
      {"seconds", settings.seconds}, {"max_drift_m", settings.max_drift_m}, {"max_turn_deg", settings.max_turn_deg}};
  json["warnings"] = scene.warnings;
  return (json);
}

std::string
stabilityCsv (const StabilitySettings& settings, const SceneStability& scene)
{
  std::string text = csvRow ({"name", "drift_m", "turn_deg", "drift_max_m", "turn_max_deg", "flew_away", "stayed"});
  for (const BodyDrift& body : scene.bodies)
    text += csvRow ({body.name, toField (body.drift_m), toField (degrees_per_rad * body.turn_rad),
                     toField (body.largest_drift_m), toField (degrees_per_rad * body.largest_turn_rad),
                     body.flew_away ? "1" : "0", settings.stayed (body) ? "1" : "0"});
  return (text);
}

bool
simulateAndMeasure (const StabilitySettings& settings, Terminal& terminal)
{
  const SceneStability scene = simulateScene (sceneFile (settings.paths[0]), settings.seconds,
                                              [&] (const std::string& stage, double fraction) {
                                                terminal.progress (stage, fraction);
                                                return (true);
                                              });
  for (const std::string& warning : scene.warnings)
    terminal.warning (warning);
  print (settings, scene, terminal);
  if (!settings.json.empty ())
    saveJson (stabilityJson (settings, scene), settings.json);
  if (!settings.csv.empty ())
    saveText (stabilityCsv (settings, scene), settings.csv);
  return (true);
}

void
check (const StabilitySettings& settings)
{
  refuseToOverwrite ({sceneFile (settings.paths[0])}, {settings.json, settings.csv});
}

void
declareStabilityOptions (CLI::App& app, StabilitySettings& settings)
{
  OptionGroup simulation (app, "Simulation");
  simulation.add ("--seconds S", settings.seconds, positiveNumber (), "Simulated time" + byDefault (settings.seconds));
  simulation.add ("--max-drift METRES", settings.max_drift_m, numberRange (0, unlimited),
                  "How far the centre of mass of a body that stays may be from its beginning" +
                      byDefault (settings.max_drift_m));
  simulation.add ("--max-turn DEGREES", settings.max_turn_deg, numberRange (0, unlimited),
                  "How far such a body may have turned" + byDefault (settings.max_turn_deg));
  declareCommonOptions (app, settings);
}

} // namespace

EvaluationCommand
stabilityCommand ()
{
  return (makeCommand<StabilitySettings> ("stability", stabilityText (), "SCENE", "", declareStabilityOptions,
                                          simulateAndMeasure, check));
}
