// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Finds the objects in a view; see pcl_cosection_segment --help.

#include "output_files.h"
#include "run_program.h"
#include "segment_command_line.h"

#include "pcl_cosection/segmentation/clusters/cloud_segmentation.h"
#include "pcl_cosection/view/organized_cloud.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <nlohmann/json.hpp>
#include <pcl/common/time.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <sstream>

using namespace pcl::cosection;

namespace {

/** \brief The objects in a view. */
struct FoundObjects
{
  struct Object
  {
    std::size_t points = 0;
    std::optional<DetectedInstance> detected; ///< by a network
  };

  std::vector<std::uint32_t> labels; ///< one per point
  std::vector<Object> objects;       ///< label n is at n - 1
  std::vector<Eigen::Vector4f> support_planes;
  std::vector<std::string> warnings; ///< without the name of the file
};

FoundObjects
findByGeometry (const SegmentSettings& settings, OrganizedCloud cloud, const Image<std::uint8_t>& ignored)
{
  for (std::size_t i = 0; i < cloud.points.size (); ++i)
    if (ignored.pixels[i] != 0)
      cloud.points[i].setConstant (std::numeric_limits<float>::quiet_NaN ());
  ObjectSegmentation found = segmentCloud (cloud, settings.segmentation);
  std::vector<std::string> warnings = warningsOf (found, settings.segmentation);
  return {std::move (found.labels), std::vector<FoundObjects::Object> (found.objects), std::move (found.support_planes),
          std::move (warnings)};
}

FoundObjects
findByNetwork (InstanceDetector& detector, const ClassRoles& roles, const OrganizedCloud& cloud,
               const Image<std::uint8_t>& ignored)
{
  const std::vector<std::array<std::uint8_t, 3>>& pixels = cloud.picture.pixels;
  if (std::all_of (pixels.begin (), pixels.end (), [] (const auto& c) { return (c == std::array<std::uint8_t, 3>{}); }))
    throw DegenerateInput (pixels.empty () ? "has no colours (a field rgb or rgba), which --method mask-rcnn needs"
                                           : "all of it is black");
  Image<std::uint8_t> readings (cloud.width, cloud.height, 0);
  for (std::size_t i = 0; i < cloud.points.size (); ++i)
    readings.pixels[i] = cloud.points[i].allFinite () && ignored.pixels[i] == 0 ? 1 : 0;
  std::vector<DetectedInstance> instances = detector.detect (cloud.picture);
  const InstanceLabels labelled = labelInstances (instances, cloud.width, cloud.height, roles, readings);
  FoundObjects found;
  found.labels.assign (labelled.labels.pixels.begin (), labelled.labels.pixels.end ());
  for (const std::size_t n : labelled.instances)
    found.objects.push_back ({0, std::move (instances[n])});
  return (found);
}

/** \brief Find them as the user asked for. \param[in] detector null: by geometry
 * \throws UsageError, Error naming the file */
FoundObjects
findObjects (const SegmentSettings& settings, const OrganizedCloud& cloud, InstanceDetector* detector)
{
  const Image<std::uint8_t> ignored = ignoredPixels (settings.ignored, cloud.width, cloud.height);
  FoundObjects found;
  try
  {
    found = detector != nullptr ? findByNetwork (*detector, settings.network->roles, cloud, ignored)
                                : findByGeometry (settings, cloud, ignored);
  }
  catch (const DegenerateInput& error)
  {
    throw DegenerateInput (settings.input + ": " + error.what ());
  }
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    if (ignored.pixels[i] != 0)
      found.labels[i] = ignored_label;
    if (found.labels[i] > 0 && found.labels[i] <= found.objects.size ())
      ++found.objects[found.labels[i] - 1].points;
  }
  return (found);
}

std::vector<std::string>
warningsOf (const OrganizedCloud& cloud)
{
  std::vector<std::string> warnings;
  if (cloud.moved)
    warnings.emplace_back ("its points are not in the frame of their sensor, which was found by their order");
  if (const std::string hint = hintOfUnit (cloud.points); !hint.empty ())
    warnings.push_back (hint);
  return warnings;
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
  summary["axes"] = settings.axes;
  summary["threads"] = options.threads;
  return (summary);
}

/** \brief What may help where no object was found. */
std::string
remedy (const SegmentSettings& settings, const FoundObjects& found)
{
  std::ostringstream sizes;
  sizes << "objects are " << settings.segmentation.min_object_size_m << " to "
        << settings.segmentation.max_object_size_m << " m long (--min-object-size, --max-object-size), and ";
  return (sizes.str () +
          (found.support_planes.empty ()
               ? "stand apart from each other"
               : "stand on the " + counted (found.support_planes.size (), "plane") + " that it shows") +
          "; is the unit the metre (else --scale 0.001)?");
}

bool
run (const SegmentSettings& given, Terminal& terminal)
{
  SegmentSettings settings = given;
  const pcl::StopWatch total;
  if (settings.network)
    readClassNames (*settings.network);
  requireWritable (settings.output);
  if (!settings.json.empty ())
    requireWritable (settings.json);
  PcdViewOptions reading;
  reading.scale = settings.scale;
  reading.world_points = settings.world_points;
  if (settings.axes == "opengl")
    reading.axes = SensorAxes::OpenGl;
  const bool needs_image = settings.network || !settings.ignored.empty ();
  const OrganizedCloud cloud = readOrganizedCloud (settings.input, reading, !needs_image);
  const double read_s = total.getTimeSeconds ();
  std::vector<std::string> warnings;
  const auto warn = [&] (const std::string& warning) {
    terminal.warning (settings.input + ": " + warning);
    warnings.push_back (settings.input + ": " + warning);
  };
  for (const std::string& warning : warningsOf (cloud))
    warn (warning);

  std::optional<InstanceDetector> detector;
  if (settings.network)
    detector.emplace (settings.network->network);
  const pcl::StopWatch segmentation;
  const FoundObjects found = findObjects (settings, cloud, detector ? &*detector : nullptr);
  const double segmentation_s = segmentation.getTimeSeconds ();
  for (const std::string& warning : found.warnings)
    warn (warning);
  copyWithLabels (settings.input, found.labels, settings.output);

  for (std::size_t n = 0; n < found.objects.size (); ++n)
    terminal.detail ("object " + std::to_string (n + 1) + ": " + nameOf (found.objects[n]) +
                     counted (found.objects[n].points, "point"));
  terminal.result ("wrote " + settings.output + ": " + counted (found.objects.size (), "object") +
                   (detector ? "" : " on " + counted (found.support_planes.size (), "plane")));
  // A network may find nothing, and what is ignored may be all objects.
  const bool is_answer = !found.objects.empty () || settings.network || !settings.ignored.empty ();
  if (!is_answer)
    terminal.error (settings.input + ": no object was found; " + remedy (settings, found));
  if (settings.json.empty ())
    return (is_answer);
  nlohmann::ordered_json summary;
  summary["timings_s"] = {{"read", read_s}, {"segmentation", segmentation_s}, {"total", total.getTimeSeconds ()}};
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
  return (is_answer);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_segment"}, argc, argv, parseSegmentCommandLine, run));
}
