// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "json_summary.h"

#include "method_json.h"
#include "output_files.h"

#include <pcl/cosection/common/error.h>

#include <nlohmann/json.hpp>

using namespace pcl::cosection;
using Json = nlohmann::ordered_json;

namespace {

Json
parameters (const Settings& settings)
{
  const CoSectionOptions& method = settings.method;
  Json result;
  result["preset"] = settings.preset.empty () ? "default" : settings.preset;
  addMethod (method, result);
  result["planes"] = Json::array ();
  for (const Eigen::Vector4d& p : settings.planes)
    result["planes"].push_back ({p[0], p[1], p[2], p[3]});
  result["free_space"] = settings.free_space;
  result["obstacles"] = settings.obstacles;
  result["object_trajectories"] = Json::object ();
  for (const auto& [label, file] : settings.object_trajectories)
    result["object_trajectories"][std::to_string (label)] = file;
  result["max_faces"] = settings.max_faces;
  result["scale"] = settings.reading.scale;
  result["world_points"] = settings.reading.world_points;
  result["viewpoints"] = settings.viewpoints;
  return (result);
}

} // namespace

void
writeJsonSummary (const Settings& settings, const SceneResult& result, const std::map<std::string, double>& timings_s,
                  const std::vector<std::string>& warnings)
{
  Json summary;
  summary["timings_s"] = timings_s;
  summary["parameters"] = parameters (settings);
  summary["objects"] = Json::array ();
  for (const ObjectResult& object : result.objects)
    if (object.error.empty ())
      summary["objects"].push_back (objectJson (object));
  summary["failed"] = Json::array ();
  for (const ObjectResult& object : result.objects)
    if (!object.error.empty ())
      summary["failed"].push_back ({{"id", object.id}, {"error", object.error}});
  summary["warnings"] = warnings;
  saveJson (summary, settings.json);
}

void
writeJsonOfFailure (const Settings& settings, const std::string& error, const std::vector<std::string>& warnings)
try
{
  Json summary;
  summary["error"] = error;
  summary["timings_s"] = Json::object ();
  summary["parameters"] = parameters (settings);
  summary["objects"] = Json::array ();
  summary["failed"] = Json::array ();
  summary["warnings"] = warnings;
  saveJson (summary, settings.json);
}
catch (const std::exception&)
{
  // the error itself is reported
}
