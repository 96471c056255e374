// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Finds the objects in a view; see pcl_cosection_segment --help.

#include "class_summary.h"
#include "found_objects.h"
#include "output_files.h"
#include "run_program.h"
#include "segment_command_line.h"
#include "stopwatch.h"
#include "terminal.h"

#include <nlohmann/json.hpp>

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <optional>

using namespace pcl::cosection;

namespace {

constexpr float large_depth_m = 100.0f; ///< what is farther is probably not in metres

std::vector<std::string>
warningsOf (const SegmentSettings& settings, const OrganizedCloud& cloud)
{
  std::vector<std::string> warnings;
  if (cloud.moved)
    warnings.push_back (settings.input +
                        ": its points are not in the frame of their sensor, which was found by their pixels");
  float depth = 0.0f;
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.allFinite ())
      depth = std::max (depth, p.z ());
  if (depth > large_depth_m)
    warnings.push_back (settings.input + ": is up to " + std::to_string (static_cast<long> (depth)) +
                        " m deep; if it is in millimetres, give --scale 0.001");
  return warnings;
}

std::string
numbered (std::size_t count, const std::string& what)
{
  return (std::to_string (count) + " " + what + (count == 1 ? "" : "s"));
}

/** \brief "cup, score 0.92, "; nothing if that is not known. */
std::string
nameOf (const FoundObjects::Object& object)
{
  if (!object.detected)
    return ("");
  return (classText (object.detected->class_id, object.detected->class_name, object.detected->score) + ", ");
}

nlohmann::ordered_json
summaryOf (std::size_t label, const FoundObjects::Object& object)
{
  nlohmann::ordered_json summary = {{"label", label}, {"points", object.points}};
  if (object.detected)
    summary.update (classJson (object.detected->class_id, object.detected->class_name, object.detected->score));
  return (summary);
}

nlohmann::ordered_json
parameters (const SegmentSettings& settings)
{
  nlohmann::ordered_json summary = {{"method", settings.network ? "mask-rcnn" : "geometric"}};
  const ObjectSegmentationOptions& options = settings.segmentation;
  if (settings.network)
    summary["network"] = networkJson (*settings.network);
  else
    summary.update ({{"max_object_size_m", options.max_object_size_m},
                     {"min_object_size_m", options.min_object_size_m},
                     {"concave_angle_rad", options.concave_angle_rad},
                     {"min_support_area_m2", options.min_support_area_m2}});
  summary["ignored_regions"] = settings.ignored.regions;
  summary["ignored_mask"] = settings.ignored.mask;
  summary["scale"] = settings.scale;
  summary["world_points"] = settings.world_points;
  summary["threads"] = options.threads;
  return (summary);
}

void
run (SegmentSettings settings, Terminal& terminal)
{
  const Stopwatch total;
  if (settings.network)
    readClassNames (*settings.network);
  requireWritable (settings.output);
  if (!settings.json.empty ())
    requireWritable (settings.json);
  PcdViewOptions reading;
  reading.scale = settings.scale;
  reading.world_points = settings.world_points;
  const OrganizedCloud cloud = readOrganizedCloud (settings.input, reading);
  const double read_s = total.seconds ();
  const std::vector<std::string> warnings = warningsOf (settings, cloud);
  for (const std::string& warning : warnings)
    terminal.warning (warning);

  std::optional<InstanceDetector> detector;
  if (settings.network)
    detector.emplace (settings.network->network);
  const Stopwatch segmentation;
  const FoundObjects found = findObjects (settings, cloud, detector ? &*detector : nullptr);
  const double segmentation_s = segmentation.seconds ();
  copyWithLabels (settings.input, found.labels, settings.output);

  for (std::size_t n = 0; n < found.objects.size (); ++n)
    terminal.detail ("object " + std::to_string (n + 1) + ": " + nameOf (found.objects[n]) +
                     numbered (found.objects[n].points, "point"));
  terminal.result ("wrote " + settings.output + ": " + numbered (found.objects.size (), "object") +
                   (detector ? "" : " on " + numbered (found.support_planes.size (), "plane")));
  if (settings.json.empty ())
    return;
  nlohmann::ordered_json summary;
  summary["timings_s"] = {{"read", read_s}, {"segmentation", segmentation_s}, {"total", total.seconds ()}};
  summary["parameters"] = parameters (settings);
  summary["objects"] = nlohmann::ordered_json::array ();
  for (std::size_t n = 0; n < found.objects.size (); ++n)
    summary["objects"].push_back (summaryOf (n + 1, found.objects[n]));
  summary["ignored_points"] = std::count (found.labels.begin (), found.labels.end (), ignored_label);
  summary["support_planes"] = nlohmann::ordered_json::array ();
  for (const Eigen::Vector4f& plane : found.support_planes)
    summary["support_planes"].push_back ({plane[0], plane[1], plane[2], plane[3]});
  summary["warnings"] = warnings;
  saveJson (summary, settings.json);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_segment"}, [&] (Terminal& terminal) {
    const std::optional<SegmentSettings> settings = parseSegmentCommandLine (argc, argv);
    if (!settings)
      return (true);
    terminal.setVerbosity (settings->verbosity);
    run (*settings, terminal);
    return (true);
  }));
}
