// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Completes the hidden surfaces of the objects in PCD views; see pcl_cosection --help.

#include "command_line.h"
#include "export_report.h"
#include "method_json.h"
#include "output_files.h"
#include "output_target.h"
#include "run_program.h"
#include "scene_input.h"

#include "pcl_cosection/io/place_text.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/surface/co_section.h>

#include <nlohmann/json.hpp>

#include <pcl/common/time.h>

#include <iomanip>
#include <sstream>
#include <tuple>
#include <utility>

using namespace pcl::cosection;
using Json = nlohmann::ordered_json;

namespace {

constexpr double read_share = 0.1; ///< of the progress bar
const char* const out_of_memory =
    "out of memory; use larger voxels (--voxel-size, --background-voxel-size) or fewer threads (--threads)";

CoSection
toScene (const Settings& settings, SceneInput input)
{
  CoSection scene (settings.method);
  for (DepthView& view : input.views)
    scene.addView (std::move (view));
  for (DepthView& view : input.free_space)
    scene.addView (std::move (view), {}, ViewUse::FreeSpace);
  if (!input.background.empty ())
    scene.setBackground (std::move (input.background));
  for (auto& [label, object] : input.objects)
    scene.addObject (std::move (object));
  for (const Eigen::Vector4d& plane : settings.planes)
    scene.addSupportPlane (relativeTo (input.origin, plane));
  for (TriangleMesh& obstacle : input.obstacles)
    scene.addObstacle (std::move (obstacle));
  return (scene);
}

/** \brief Fewer triangles, if that is asked for. The bounds stay as they are, lest they bound no more. */
void
simplify (std::size_t max_faces, SceneResult& result)
{
  if (max_faces == 0)
    return;
  for (ObjectResult& object : result.objects)
    if (!object.mesh.empty ())
      object.mesh = decimate (object.mesh, max_faces);
  if (!result.background.empty ())
    result.background = decimate (result.background, max_faces);
}

std::string
summaryLine (const ObjectResult& object)
{
  std::ostringstream text;
  text << "object " << object.id << ": " << object.mesh.vertices.size () << " vertices, " << std::setprecision (3)
       << 1000.0 * computeMassProperties (object.mesh).volume_m3 << " litres";
  if (object.signed_distance)
    text << ", voxels of " << 1000.0 * object.signed_distance->grid.voxel_size_m << " mm";
  if (object.penetration_m > 0.0)
    text << ", " << 1000.0 * object.penetration_m << " mm inside another body";
  if (object.proposal)
    text << ", proposal " << (object.proposal->used ? "used" : "not used: it does not explain what was measured");
  if (object.learned)
    text << ", the network's answer " << (object.learned->used ? "used" : "not used: the views do not confirm it");
  return (text.str ());
}

Json
parameters (const Settings& settings)
{
  Json result;
  result["preset"] = settings.preset.empty () ? "default" : settings.preset;
  addMethod (settings.method, result);
  result["planes"] = planesJson (settings.planes);
  result["free_space"] = settings.free_space;
  result["obstacles"] = settings.obstacles;
  result["object_trajectories"] = Json::object ();
  for (const auto& [label, file] : settings.object_trajectories)
    result["object_trajectories"][std::to_string (label)] = file;
  result["proposals"] = Json::array ();
  for (const auto& [label, file] : settings.proposals)
    result["proposals"].push_back (std::to_string (label) + "=" + file);
  result["model"] = settings.model;
  result["max_faces"] = settings.max_faces;
  result["scale"] = settings.reading.scale;
  result["world_points"] = settings.reading.world_points;
  result["viewpoints"] = settings.viewpoints;
  result["segment"] = settings.segment;
  result["axes"] = settings.axes;
  result["background"] = settings.reading.background_labels;
  result["ignore"] = settings.reading.ignored_labels;
  return (result);
}

Json
summaryJson (const Settings& settings, const SceneResult& result, const Eigen::Vector3d& origin,
             const std::map<std::string, double>& timings_s, const std::vector<std::string>& warnings)
{
  Json summary;
  summary["timings_s"] = timings_s;
  summary["parameters"] = parameters (settings);
  if (!origin.isZero (0.0))
    summary["origin_m"] = {origin.x (), origin.y (), origin.z ()};
  summary["objects"] = Json::array ();
  summary["failed"] = Json::array ();
  for (const ObjectResult& object : result.objects)
    if (object.error.empty ())
      summary["objects"].push_back (
          objectJson (object, settings.object_trajectories.count (object.id) == 0 ? origin : Eigen::Vector3d::Zero ()));
    else
      summary["failed"].push_back ({{"id", object.id}, {"error", object.error}});
  summary["support_planes"] = planesJson (result.planes, origin);
  summary["warnings"] = warnings;
  return (summary);
}

/** \brief The network that was asked for, or else the installed one; without that one the learned prior is off. */
void
loadNetwork (Settings& settings, std::vector<std::string>& warnings)
{
  if (!settings.model.empty ())
    settings.method.completion_network = loadCompletionNetwork (settings.model);
  else if (const std::string installed = completionNetworkFile ();
           !installed.empty () && settings.method.activePriors ().learned)
    try
    {
      settings.method.completion_network = loadCompletionNetwork (installed);
      settings.model = installed;
    }
    catch (const IoError& error)
    {
      warnings.push_back (std::string ("the learned prior is off: ") + error.what ());
    }
}

/** \brief Read, complete, write. \return whether every object succeeded, and whether any did */
std::pair<bool, bool>
complete (Settings settings, const OutputTarget& target, std::vector<std::string>& warnings, Terminal& terminal)
{
  const pcl::StopWatch total;
  SceneInput input = readScene (settings, [&] (const std::string& stage, double fraction) {
    terminal.progress (stage, read_share * fraction);
    return (!interrupted ());
  });
  const double read_s = total.getTimeSeconds ();
  const Eigen::Vector3d origin = input.origin;
  warnings = input.warnings;
  if (!origin.isZero (0.0) && settings.format == "stl")
    warnings.push_back ("STL files have single precision: coordinates in them are relative to " + placeText (origin));
  loadNetwork (settings, warnings);
  for (const std::string& warning : warnings)
    terminal.warning (warning);

  SceneResult result = toScene (settings, std::move (input))
                           .reconstruct ([&] (const std::string& stage, double fraction) {
                             terminal.progress (stage, read_share + (1.0 - read_share) * fraction);
                             return (!interrupted ());
                           });
  if (interrupted ())
    throw Cancelled ("interrupted");

  for (const std::string& warning : result.warnings)
    terminal.warning (warning);
  warnings.insert (warnings.end (), result.warnings.begin (), result.warnings.end ());
  simplify (settings.max_faces, result);
  bool all_good = true;
  for (const ObjectResult& object : result.objects)
    if (object.error.empty ())
      terminal.result (summaryLine (object));
  for (const std::string& failure : failureTexts (result.objects))
  {
    all_good = false;
    warnings.push_back (failure);
    terminal.error (failure);
  }
  for (const std::string& file : target.write (result, origin))
    terminal.result ("wrote " + file);

  std::map<std::string, double> timings_s = result.timings_s;
  timings_s["read"] = read_s;
  timings_s["total"] = total.getTimeSeconds ();
  target.writeSummary (summaryJson (settings, result, origin, timings_s, warnings));
  for (const auto& [stage, seconds] : timings_s)
    terminal.detail (stage + ": " + std::to_string (seconds) + " s");
  return {all_good, anyCompleted (result)};
}

bool
run (const Settings& settings, Terminal& terminal)
{
  catchInterruptions ();
  const OutputTarget target (settings);
  std::vector<std::string> warnings;
  bool all_good = false, any = false;
  try
  {
    std::tie (all_good, any) = complete (settings, target, warnings, terminal);
  }
  catch (const Cancelled&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    saveFailure (describe (error, out_of_memory), parameters (settings), warnings,
                 {settings.json, target.formerSummary ()});
    throw;
  }
  if (any)
    exportBeside (settings.output, settings.exports, settings.threads, terminal);
  return (all_good);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection", "interrupted, nothing was written", out_of_memory}, argc, argv,
                      parseCommandLine, run));
}
