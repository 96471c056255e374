// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "segment_command_line.h"

#include "option_values.h"
#include "output_files.h"

#include <pcl/cosection/common/error.h>

using namespace pcl::cosection;

const ProgramText&
segmentationText ()
{
  static const ProgramText text = {
      "pcl_cosection_segment",
      "find the objects in an organised point cloud",
      "pcl_cosection_segment [OPTIONS] INPUT.pcd OUTPUT.pcd",
      "Finds the objects in a view, one label for each: by their geometry what stands on a table, a shelf or the "
      "floor, or by their colours with an "
      "instance segmentation network of yours.",
      {"INPUT.pcd is an organised cloud in its sensor's frame, as a depth camera's driver gives it.",
       "OUTPUT.pcd is the same cloud with the field label: 0 background, 1 ... objects, the largest in the image "
       "first, 65535 neither. Width, "
       "height, order, viewpoint and the other fields stay; labels of INPUT.pcd are replaced. pcl_cosection reads it."},
      {
          {"pcl_cosection_segment view.pcd labelled.pcd", "objects up to half a metre"},
          {"pcl_cosection_segment --max-object-size 0.8 view.pcd labelled.pcd", "larger ones, too"},
          {"pcl_cosection_segment in.pcd out.pcd && pcl_cosection out.pcd meshes", "from a view to closed meshes"},
          {"pcl_cosection_segment --method mask-rcnn --model net.onnx in.pcd out.pcd", "with a network of yours"},
      },
      {"max-object-size = 0.8", "concave-angle = 0.35"},
  };
  return (text);
}

void
declareSegmentationOptions (CLI::App& app, GivenSegmentation& given)
{
  const ObjectSegmentationOptions defaults;
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  app.add_option ("--method", given.method, "Find objects by geometry or with a network (default: geometric)")
      ->option_text ("geometric|mask-rcnn")
      ->check (oneOf ({"geometric", "mask-rcnn"}))
      ->group ("Input");
  const std::string objects = "Geometry";
  app.add_option ("--max-object-size", given.max_object_size,
                  "What is longer is furniture or room, metres" + byDefault (defaults.max_object_size_m))
      ->option_text ("METRES")
      ->check (numberRange (0.0, unlimited, true))
      ->group (objects);
  app.add_option ("--min-object-size", given.min_object_size,
                  "Anything shorter is not an object, metres" + byDefault (defaults.min_object_size_m))
      ->option_text ("METRES")
      ->check (numberRange (0.0, unlimited, true))
      ->group (objects);
  app.add_option ("--concave-angle", given.concave_angle,
                  "A crease more concave than this separates objects, radians" + byDefault (defaults.concave_angle_rad))
      ->option_text ("RADIANS")
      ->check (numberRange (0.0, 1.57, true))
      ->group (objects);
  app.add_option ("--min-support-area", given.min_support_area,
                  "The largest plane must show so much, square metres" + byDefault (defaults.min_support_area_m2))
      ->option_text ("AREA")
      ->check (numberRange (0.0, unlimited, true))
      ->group (objects);
  declareNetworkOptions (app, given.network);
  const std::string input = "Input";
  app.add_option ("--scale", given.scale, "Multiplies coordinates: 0.001 for millimetres (default: 1)")
      ->option_text ("FACTOR")
      ->check (numberRange (0.0, unlimited, true))
      ->group (input);
  app.add_flag ("--world-points", given.world_points, "Points are in the world frame, not in the sensor's")
      ->group (input);
  declareIgnoredArea (app, given.ignored);
  app.add_option ("--json", given.json, "Write a summary for programs")->option_text ("FILE")->group ("Output");
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_segment", given.verbose, given.quiet);
}

namespace {

/** \brief The method, and that no option is of the other one. */
void
setMethod (const GivenSegmentation& given, SegmentSettings& settings)
{
  const std::string of_network = anyNetworkOption (given.network);
  if (given.method != "mask-rcnn")
  {
    if (!of_network.empty ())
      throw UsageError (of_network + " needs --method mask-rcnn");
    return;
  }
  if (given.network.model.empty ())
    throw UsageError ("--method mask-rcnn needs a network: --model FILE");
  if (given.max_object_size || given.min_object_size || given.concave_angle || given.min_support_area)
    throw UsageError (std::string (given.max_object_size   ? "--max-object-size"
                                   : given.min_object_size ? "--min-object-size"
                                   : given.concave_angle   ? "--concave-angle"
                                                           : "--min-support-area") +
                      " needs --method geometric");
  settings.network = networkSettings (given.network);
}

} // namespace

std::optional<SegmentSettings>
parseSegmentCommandLine (int argc, const char* const* argv)
{
  GivenSegmentation given;
  CLI::App app;
  declareSegmentationOptions (app, given);
  if (!parseArguments (app, segmentationText (), argc, argv))
    return (std::nullopt);
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  if (given.paths.size () < 2)
    throw UsageError (given.paths.empty () ? "INPUT.pcd and OUTPUT.pcd are missing; see --help"
                                           : "OUTPUT.pcd is missing after " + given.paths[0] + "; see --help");
  if (given.paths.size () > 2)
    throw UsageError ("there is one argument too many: " + given.paths[2]);
  SegmentSettings settings;
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  settings.input = given.paths[0];
  settings.output = given.paths[1];
  settings.json = given.json;
  const std::string ending = ".pcd";
  if (settings.output.size () <= ending.size () ||
      settings.output.compare (settings.output.size () - ending.size (), ending.size (), ending) != 0)
    throw UsageError ("OUTPUT is \"" + settings.output + "\"; it must be the name of a .pcd file");
  setMethod (given, settings);
  settings.ignored = ignoredArea (given.ignored);
  refuseToOverwrite ({settings.input, settings.ignored.mask, given.network.model, given.network.model_config,
                      given.network.class_names},
                     {settings.output, settings.json});
  ObjectSegmentationOptions& options = settings.segmentation;
  options.max_object_size_m = given.max_object_size.value_or (options.max_object_size_m);
  options.min_object_size_m = given.min_object_size.value_or (options.min_object_size_m);
  options.concave_angle_rad = given.concave_angle.value_or (options.concave_angle_rad);
  options.min_support_area_m2 = given.min_support_area.value_or (options.min_support_area_m2);
  options.threads = given.threads.value_or (0);
  if (options.min_object_size_m >= options.max_object_size_m)
    throw UsageError ("--min-object-size must be less than --max-object-size");
  settings.scale = given.scale.value_or (1.0);
  settings.world_points = given.world_points;
  return (settings);
}
