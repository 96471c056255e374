// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "complete_views.h"

#include "completion_frame.h"
#include "method_json.h"

#include "pcl_cosection/io/place_text.h"

#include <pcl/cosection/common/mesh_decimation.h>

#include <pcl/common/time.h>

#include <algorithm>
#include <utility>

using namespace pcl::cosection;

namespace {

constexpr double read_share = 0.1; ///< of the progress

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
  for (const Eigen::Vector4d& plane : input.planes)
    scene.addSupportPlane (plane);
  for (TriangleMesh& obstacle : input.obstacles)
    scene.addObstacle (std::move (obstacle));
  return (scene);
}

std::vector<ViewOrigin>
originsOf (const SceneInput& input)
{
  std::vector<ViewOrigin> origins;
  for (std::size_t n = 0; n < input.views.size (); ++n)
  {
    const std::vector<float>& depth = input.views[n].depth;
    if (std::none_of (depth.begin (), depth.end (), [] (float z) { return (z > 0.0f); })) // has no viewpoint
      continue;
    origins.push_back ({input.view_inputs[n], input.views[n].camera, input.views[n].T_world_sensor, {}});
    for (const auto& [id, object] : input.objects)
      if (n < object.T_world_object.size () && object.T_world_object[n].matrix ().allFinite ())
        origins.back ().T_world_object[id] = object.T_world_object[n];
  }
  return (origins);
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

} // namespace

CompletedViews
completeViews (Settings& settings, const SceneReaders& readers, const ProgressCallback& progress,
               const WarningCallback& warning)
{
  const pcl::StopWatch total;
  const auto go = [&] (const std::string& stage, double fraction) { return (!progress || progress (stage, fraction)); };
  const auto tell = [&] (const std::vector<std::string>& lines) {
    for (const std::string& line : lines)
      if (warning)
        warning (line);
  };
  SceneInput input = readScene (
      settings, [&] (const std::string& stage, double fraction) { return (go (stage, read_share * fraction)); },
      readers);
  const double read_s = total.getTimeSeconds ();
  CompletedViews completed;
  completed.origin = input.origin;
  completed.views = originsOf (input);
  completed.warnings = input.warnings;
  if (!input.origin.isZero (0.0) && settings.format == "stl")
    completed.warnings.push_back ("STL files have single precision: coordinates in them are relative to " +
                                  placeText (input.origin));
  loadNetwork (settings, completed.warnings);
  tell (completed.warnings);

  const Eigen::Quaterniond R_world_frame = completionFrame (input);
  const bool is_turned = !R_world_frame.isApprox (Eigen::Quaterniond::Identity (), 0.0);
  if (is_turned)
    turnInput (R_world_frame.conjugate (), input);
  SceneResult& scene = completed.scene;
  scene = toScene (settings, std::move (input)).reconstruct ([&] (const std::string& stage, double fraction) {
    return (go (stage, read_share + (1.0 - read_share) * fraction));
  });
  if (!go ("done", 1.0))
    throw Cancelled ("interrupted");
  if (is_turned)
    turnResult (R_world_frame, settings, scene);
  tell (scene.warnings);
  completed.warnings.insert (completed.warnings.end (), scene.warnings.begin (), scene.warnings.end ());
  for (const std::string& failure : failureTexts (scene.objects))
    completed.warnings.push_back (failure);
  simplify (settings.max_faces, scene);
  scene.timings_s["read"] = read_s;
  scene.timings_s["total"] = total.getTimeSeconds ();
  return (completed);
}

nlohmann::ordered_json
parametersJson (const Settings& settings)
{
  nlohmann::ordered_json result;
  result["preset"] = settings.preset.empty () ? "default" : settings.preset;
  addMethod (settings.method, result);
  result["planes"] = planesJson (settings.planes);
  result["free_space"] = settings.free_space;
  result["obstacles"] = settings.obstacles;
  result["object_trajectories"] = nlohmann::ordered_json::object ();
  for (const auto& [label, file] : settings.object_trajectories)
    result["object_trajectories"][std::to_string (label)] = file;
  result["proposals"] = nlohmann::ordered_json::array ();
  for (const auto& [label, file] : settings.proposals)
    result["proposals"].push_back (std::to_string (label) + "=" + file);
  result["model"] = settings.model;
  result["max_faces"] = settings.max_faces;
  result["scale"] = settings.reading.scale;
  result["world_points"] = settings.reading.world_points;
  result["viewpoints"] = settings.viewpoints;
  result["segment"] = settings.segment;
  result["axes"] = settings.axes;
  result["format"] = settings.format;
  result["background"] = settings.reading.background_labels;
  result["ignore"] = settings.reading.ignored_labels;
  return (result);
}

nlohmann::ordered_json
summaryJson (const Settings& settings, const CompletedViews& completed)
{
  const SceneResult& scene = completed.scene;
  const Eigen::Vector3d& origin = completed.origin;
  nlohmann::ordered_json summary;
  summary["timings_s"] = scene.timings_s;
  summary["parameters"] = parametersJson (settings);
  if (!origin.isZero (0.0))
    summary["origin_m"] = {origin.x (), origin.y (), origin.z ()};
  summary["views"] = nlohmann::ordered_json::array ();
  for (const ViewOrigin& view : completed.views)
  {
    nlohmann::ordered_json entry = {{"input", view.input},
                                    {"camera", cameraJson (view.camera)},
                                    {"T_world_sensor", transformJson (view.T_world_sensor, origin)}};
    for (const auto& [id, T_world_object] : view.T_world_object)
      entry["T_world_object"][std::to_string (id)] = transformJson (T_world_object, origin);
    summary["views"].push_back (std::move (entry));
  }
  summary["objects"] = nlohmann::ordered_json::array ();
  summary["failed"] = nlohmann::ordered_json::array ();
  for (const ObjectResult& object : scene.objects)
    if (object.error.empty ())
      summary["objects"].push_back (
          objectJson (object, settings.object_trajectories.count (object.id) == 0 ? origin : Eigen::Vector3d::Zero ()));
    else
      summary["failed"].push_back ({{"id", object.id}, {"error", object.error}});
  summary["support_planes"] = planesJson (scene.planes, origin);
  summary["warnings"] = completed.warnings;
  return (summary);
}
