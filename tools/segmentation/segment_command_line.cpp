// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "segment_command_line.h"

#include "option_values.h"
#include "output_files.h"

using namespace pcl::cosection;

namespace {

/** \brief The method, and that no option is of the other one. */
void
setMethod (SegmentSettings& settings)
{
  const std::string of_network = anyNetworkOption (settings.given_network);
  if (settings.method != "mask-rcnn")
  {
    if (!of_network.empty ())
      throw UsageError (of_network + " needs --method mask-rcnn");
    return;
  }
  if (settings.given_network.model.empty ())
    throw UsageError ("--method mask-rcnn needs a network: --model FILE");
  for (const auto& [name, value] : {std::pair ("--max-object-size", &settings.max_object_size),
                                    std::pair ("--min-object-size", &settings.min_object_size),
                                    std::pair ("--concave-angle", &settings.concave_angle),
                                    std::pair ("--min-support-area", &settings.min_support_area)})
    if (*value)
      throw UsageError (std::string (name) + " needs --method geometric");
  settings.network = networkSettings (settings.given_network);
}

void
interpret (SegmentSettings& settings)
{
  requirePaths (settings.paths, "INPUT", "OUTPUT.pcd");
  settings.input = settings.paths[0];
  settings.output = settings.paths[1];
  if (settings.input.empty ())
    throw UsageError ("INPUT is empty; it must be the name of a .pcd or .ply file");
  if (!endsWith (settings.output, ".pcd"))
    throw UsageError ("OUTPUT is \"" + settings.output + "\"; it must be the name of a .pcd file");
  setMethod (settings);
  settings.ignored = ignoredArea (settings.given_area);
  const GivenNetwork& network = settings.given_network;
  refuseToOverwrite ({settings.input, configurationFile (settings.arguments), settings.ignored.mask, network.model,
                      network.model_config, network.class_names},
                     {settings.output, settings.json});
  ObjectSegmentationOptions& options = settings.segmentation;
  override (options.max_object_size_m, settings.max_object_size);
  override (options.min_object_size_m, settings.min_object_size);
  override (options.concave_angle_rad, settings.concave_angle);
  override (options.min_support_area_m2, settings.min_support_area);
  options.threads = settings.threads;
  if (options.min_object_size_m >= options.max_object_size_m)
    throw UsageError ("--min-object-size must be less than --max-object-size");
}

} // namespace

const ProgramText&
segmentationText ()
{
  static const ProgramText text = {
      "pcl_cosection_segment",
      "find the objects in a point cloud",
      "pcl_cosection_segment [OPTIONS] INPUT OUTPUT.pcd",
      "Finds the objects in a view, one label for each: by their geometry what stands on a table, a shelf or the "
      "floor, or by their colours with an instance segmentation network of yours.",
      {"INPUT is a PCD or PLY file, best an organised cloud in its sensor's frame, as a depth camera's driver gives "
       "it. In "
       "one without an order, clusters of points that stand on a plane are the objects.",
       "OUTPUT.pcd is the same cloud with the field label: 0 background, 1 ... objects, the largest in the image "
       "first, 65535 neither. Width, height, order, viewpoint and the other fields stay; labels of INPUT are "
       "replaced. pcl_cosection reads it."},
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
  OptionGroup input (app, "Input"), geometry (app, "Geometry");
  input.add ("--method geometric|mask-rcnn", given.method,
             "Find objects by geometry or with a network (default: geometric)");
  geometry.add ("--max-object-size METRES", given.max_object_size, positiveNumber (),
                "What is longer is furniture or room, metres" + byDefault (defaults.max_object_size_m));
  geometry.add ("--min-object-size METRES", given.min_object_size, positiveNumber (),
                "Anything shorter is not an object, metres" + byDefault (defaults.min_object_size_m));
  geometry.add ("--concave-angle RADIANS", given.concave_angle, numberRange (0.0, 1.57, true),
                "A crease more concave than this separates objects, radians" + byDefault (defaults.concave_angle_rad));
  geometry.add ("--min-support-area AREA", given.min_support_area, positiveNumber (),
                "The largest plane must show so much, square metres" + byDefault (defaults.min_support_area_m2));
  declareNetworkOptions (app, given.given_network);
  input.add ("--scale FACTOR", given.scale, positiveNumber (),
             "Multiplies coordinates: 0.001 for millimetres (default: 1)");
  input.addFlag ("--world-points", given.world_points, "Points are in the world frame, not in the sensor's");
  input.add ("--axes optical|opengl", given.axes,
             "Axes of the sensor's frame: x right, y down, z forward, or x right, y up, z backward" +
                 byDefault ("optical"));
  declareIgnoredArea (app, given.given_area);
  OptionGroup (app, "Output").add ("--json FILE", given.json, "Write a summary for programs");
  declareGeneralOptions (app, "pcl_cosection_segment", given);
}

std::optional<SegmentSettings>
parseSegmentCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<SegmentSettings> (argc, argv, segmentationText (), declareSegmentationOptions, interpret));
}
