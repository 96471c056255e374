// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// Finds the objects in a view; see pcl_cosection_segment --help.

#include "exit_status.h"
#include "output_files.h"
#include "segment_command_line.h"
#include "terminal.h"

#include <nlohmann/json.hpp>

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/organized_cloud.h>

#include <chrono>
#include <iostream>
#include <sstream>

using namespace pcl::cosection;

namespace
{

constexpr float large_depth_m = 100.0f; ///< what is farther is probably not in metres

class Stopwatch
{
public:
  double
  seconds () const
  {
    return (std::chrono::duration<double> (std::chrono::steady_clock::now () - start_).count ());
  }

private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now ();
};

ObjectSegmentation
findObjects (const SegmentSettings& settings, const OrganizedCloud& cloud)
try
{
  return (segmentObjects (cloud.points, cloud.width, cloud.height, settings.segmentation));
}
catch (const DegenerateInput& error)
{
  throw DegenerateInput (settings.input + ": " + error.what ());
}

std::vector<std::string>
warningsOf (const SegmentSettings& settings, const OrganizedCloud& cloud)
{
  float depth = 0.0f;
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.allFinite ())
      depth = std::max (depth, p.z ());
  if (depth <= large_depth_m)
    return {};
  return {settings.input + ": is up to " + std::to_string (static_cast<long> (depth)) +
          " m deep; if it is in millimetres, give --scale 0.001"};
}

std::string
numbered (std::size_t count, const std::string& what)
{
  return (std::to_string (count) + " " + what + (count == 1 ? "" : "s"));
}

void
run (const SegmentSettings& settings, Terminal& terminal)
{
  const Stopwatch total;
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

  const Stopwatch segmentation;
  const ObjectSegmentation found = findObjects (settings, cloud);
  const double segmentation_s = segmentation.seconds ();
  copyWithLabels (settings.input, found.labels, settings.output);

  std::vector<std::size_t> pixels (found.objects + 1, 0);
  for (const std::uint32_t label : found.labels)
    ++pixels[label];
  for (std::uint32_t label = 1; label <= found.objects; ++label)
    terminal.detail ("object " + std::to_string (label) + ": " + numbered (pixels[label], "point"));
  terminal.result ("wrote " + settings.output + ": " + numbered (found.objects, "object") + " on " +
                   numbered (found.support_planes.size (), "plane"));
  if (settings.json.empty ())
    return;
  nlohmann::ordered_json summary;
  summary["timings_s"] = {{"read", read_s}, {"segmentation", segmentation_s}, {"total", total.seconds ()}};
  const ObjectSegmentationOptions& options = settings.segmentation;
  summary["parameters"] = {{"max_object_size_m", options.max_object_size_m},
                           {"min_object_size_m", options.min_object_size_m},
                           {"concave_angle_rad", options.concave_angle_rad},
                           {"min_support_area_m2", options.min_support_area_m2},
                           {"scale", settings.scale},
                           {"world_points", settings.world_points},
                           {"threads", options.threads}};
  summary["objects"] = nlohmann::ordered_json::array ();
  for (std::uint32_t label = 1; label <= found.objects; ++label)
    summary["objects"].push_back ({{"label", label}, {"points", pixels[label]}});
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
  Terminal terminal ("pcl_cosection_segment");
  try
  {
    const std::optional<SegmentSettings> settings = parseSegmentCommandLine (argc, argv);
    if (!settings)
      return (Success);
    terminal.setVerbosity (settings->verbosity);
    run (*settings, terminal);
    return (Success);
  }
  catch (const UsageError& error)
  {
    terminal.error (error.what ());
    return (WrongUsage);
  }
  catch (const std::bad_alloc&)
  {
    terminal.error ("out of memory");
  }
  catch (const std::exception& error)
  {
    terminal.error (error.what ());
  }
  return (Failure);
}
