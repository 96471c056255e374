// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_command_line.h"

#include "frame_span.h"
#include "option_values.h"
#include "segmenter_choice.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

void
declareInput (CLI::App& app, GivenFusion& given)
{
  const std::string group = "Input";
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  app.add_option ("--format", given.format, "Layout of DATASET (default: found out)")
      ->option_text ("cofusion|tum|7scenes")
      ->check (CLI::IsMember (std::vector<std::string>{"cofusion", "tum", "7scenes"}))
      ->group (group);
  app.add_option ("--depth-dir", given.depth_dir, "Folder of the depth images (default: depth_noise, else depth)")
      ->option_text ("NAME")
      ->group (group);
  app.add_option ("--depth-scale", given.depth_scale,
                  "Units of a depth PNG per metre (default: 5000 for the layout tum, else 1000)")
      ->option_text ("FACTOR")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--intrinsics", given.intrinsics, "Camera in pixels, instead of calibration.txt")
      ->option_text ("FX,FY,CX,CY")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option ("--frames", given.frames, "Only the frames from A up to but without B, counted from 0 (default: all)")
      ->option_text ("A:B")
      ->group (group);
  declareIgnoredArea (app, given.ignored);
  app.add_option ("--max-depth", given.max_depth, "Leave out readings that are farther away (default: 10)")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
}

void
declareKnown (CLI::App& app, GivenFusion& given)
{
  const std::string group = "Known";
  app.add_option ("--camera-trajectory", given.camera_trajectory,
                  "Poses of the camera in the world: lines \"stamp tx ty tz qx qy qz qw\" (default: those of the "
                  "layout 7scenes; "
                  "without, camera and objects are tracked)")
      ->option_text ("FILE")
      ->group (group);
  app.add_option (
         "--object-trajectory", given.object_trajectories,
         "Poses of object ID in the world, beside those of the camera; repeatable. Objects without one are at rest")
      ->option_text ("ID=FILE")
      ->allow_extra_args (false)
      ->group (group);
  app.add_option (
         "--masks", given.masks,
         "Folder of PNGs of 8 or 16 bits, one per frame that has one: pixel = number of an object, 0 = background "
         "(default: there are no objects)")
      ->option_text ("DIR")
      ->group (group);
  app.add_option (
         "--mask-ids", given.mask_ids,
         "Whether an object has the same number in all masks (default: persistent with given poses, else per-frame)")
      ->option_text ("persistent|per-frame")
      ->check (CLI::IsMember (std::vector<std::string>{"persistent", "per-frame"}))
      ->group (group);
}

void
declareSegmentation (CLI::App& app, GivenFusion& given)
{
  app.add_option ("--segmentation", given.segmentation,
                  "Find the objects in every tenth frame instead of reading masks; geometric: what stands on planes; "
                  "motion: what has begun to move; mask-rcnn: with a network")
      ->option_text ("geometric|motion|mask-rcnn")
      ->check (CLI::IsMember (segmenterNames ()))
      ->group ("Known");
}

void
declareRun (CLI::App& app, GivenFusion& given)
{
  const std::string group = "Sequence";
  app.add_option ("--keyframe-every", given.keyframe_every,
                  "Take the points of every N-th frame; of the others, free space (default: 10)")
      ->option_text ("N")
      ->check (wholeRange (1, 1000000))
      ->group (group);
  app.add_option ("--max-views", given.max_views,
                  "Keep at most so many depth images; those most like others are given up (default: 100)")
      ->option_text ("N")
      ->check (wholeRange (4, 100000))
      ->group (group);
  app.add_flag ("--save-keyframes", given.save_keyframes,
                "Complete everything at keyframes too, beside the tracking, and write it to keyframes/STAMP/; of "
                "keyframes that come "
                "meanwhile the last")
      ->group (group);
  app.add_flag ("--deterministic", given.deterministic,
                "With --save-keyframes, wait for each keyframe, so that all are written; the last result is the same "
                "in any case")
      ->group (group);
  app.add_flag ("--live", given.live,
                "Show it in a window while it runs, and the result then; without influence on that")
      ->group (group);
  app.add_option ("--json", given.json, "Write the summary to this file as well")
      ->option_text ("FILE")
      ->group ("General");
  app.add_option ("--threads", given.threads, "Threads to use, without influence on results (default: all processors)")
      ->option_text ("N")
      ->check (wholeRange (1, 1024))
      ->group ("General");
  declareGeneralOptions (app, "pcl_cosection_fusion", given.verbose, given.quiet);
}

constexpr double coarsest_tracking_voxel_m = 0.02; // coarser ones lose small objects
constexpr double last_number = 1e12;               // of a frame

SequenceSource
toSource (const GivenFusion& given)
{
  SequenceSource source;
  if (!given.format.empty ())
    source.format = given.format == "cofusion" ? SequenceFormat::CoFusion
                    : given.format == "tum"    ? SequenceFormat::Tum
                                               : SequenceFormat::SevenScenes;
  source.depth_folder = given.depth_dir;
  source.depth_scale = given.depth_scale.value_or (0.0);
  if (!given.intrinsics.empty ())
  {
    const auto intrinsics = parseTuples<4> (given.intrinsics);
    if (!intrinsics || intrinsics->size () != 1 || !((*intrinsics)[0][0] > 0.0) || !((*intrinsics)[0][1] > 0.0))
      throw UsageError ("--intrinsics must be four numbers fx,fy,cx,cy with positive fx and fy");
    source.intrinsics = (*intrinsics)[0];
  }
  return (source);
}

void
setPaths (const GivenFusion& given, FusionSettings& settings)
{
  if (given.paths.empty ())
    throw UsageError ("DATASET and OUTPUT are missing; see --help");
  if (given.paths.size () == 1)
    throw UsageError ("OUTPUT is missing after " + given.paths[0] + "; see --help");
  if (given.paths.size () > 2)
    throw UsageError ("there is one argument too many: " + given.paths[2]);
  settings.dataset = given.paths[0];
  settings.output = given.paths[1];
  if (settings.dataset.empty () || settings.output.empty ())
    throw UsageError (std::string (settings.dataset.empty () ? "DATASET" : "OUTPUT") +
                      " is empty; it must be a folder");
}

FusionSettings
toSettings (const GivenFusion& given)
{
  FusionSettings settings;
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  setPaths (given, settings);
  settings.source = toSource (given);
  settings.camera_trajectory = given.camera_trajectory;
  settings.object_trajectories = parseObjectFiles ("--object-trajectory", given.object_trajectories);
  settings.masks = given.masks;
  if (!settings.object_trajectories.empty () && settings.masks.empty ())
    throw UsageError ("--object-trajectory needs --masks, which show the objects' pixels");
  if (!given.mask_ids.empty () && settings.masks.empty ())
    throw UsageError ("--mask-ids needs --masks");
  if (!settings.object_trajectories.empty () && given.mask_ids == "per-frame")
    throw UsageError ("--object-trajectory needs objects with the same number in all masks, not --mask-ids per-frame");
  settings.ignored = ignoredArea (given.ignored);
  settings.segmentation = given.segmentation;
  if (!settings.segmentation.empty () && !settings.masks.empty ())
    throw UsageError ("--masks and --segmentation exclude each other");
  if (!settings.segmentation.empty () && !settings.camera_trajectory.empty ())
    throw UsageError ("--segmentation needs tracking: it excludes --camera-trajectory");
  const std::string of_network = anyNetworkOption (given.network);
  if (settings.segmentation == "mask-rcnn")
  {
    if (given.network.model.empty ())
      throw UsageError ("--segmentation mask-rcnn needs a network: --model FILE");
    settings.network = networkSettings (given.network);
  }
  else if (!of_network.empty ())
    throw UsageError (of_network + " needs --segmentation mask-rcnn");
  settings.preset = given.preset;
  settings.save_keyframes = given.save_keyframes;
  settings.live = given.live;
  settings.json = given.json;
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;

  FusionOptions& fusion = settings.fusion;
  const CoSectionOptions defaults = fusion.backend.method;
  fusion.backend.method = methodOptions (given);
  fusion.backend.method.whole_background = defaults.whole_background;
  fusion.backend.method.min_points = defaults.min_points;
  if (!given.frames.empty ())
  {
    const FrameSpan frames = parseFrames (given.frames, last_number);
    fusion.frames = {frames.first, frames.last.value_or (fusion.frames.last)};
  }
  fusion.keyframe_every = given.keyframe_every.value_or (fusion.keyframe_every);
  fusion.keyframe.max_depth_m = given.max_depth.value_or (fusion.keyframe.max_depth_m);
  fusion.keyframe.threads = fusion.backend.method.threads;
  fusion.tsdf.tsdf.threads = fusion.backend.method.threads;
  fusion.front_end.max_depth_m = fusion.keyframe.max_depth_m;
  if (given.background_voxel_size)
    fusion.front_end.background_voxel_size_m = std::min (*given.background_voxel_size, coarsest_tracking_voxel_m);
  fusion.front_end.threads = fusion.backend.method.threads;
  fusion.front_end.persistent_ids = given.mask_ids == "persistent";
  settings.ids_per_frame = given.mask_ids == "per-frame";
  if (given.save_keyframes)
    fusion.updates = given.deterministic ? KeyframeUpdates::InStep : KeyframeUpdates::Beside;
  if (given.max_views)
  {
    fusion.backend.max_views = static_cast<std::size_t> (*given.max_views);
    fusion.backend.max_keyframes = std::max<std::size_t> (
        2, std::min (fusion.backend.max_keyframes, fusion.backend.max_views - 1));
  }
  fusion.validate ();
  return (settings);
}

} // namespace

const ProgramText&
fusionText ()
{
  static const ProgramText text = {
      "pcl_cosection_fusion",
      "complete the objects of an RGB-D sequence",
      "pcl_cosection_fusion [OPTIONS] DATASET OUTPUT",
      "Tracks the camera and the objects of an RGB-D sequence, unless their poses are given, and completes the objects "
      "and the background.",
      {"DATASET is a folder with colour and depth images in the layout of Co-Fusion (colour/, depth_noise/ or depth/, "
       "calibration.txt), of TUM's benchmark (associations.txt, or rgb.txt and depth.txt), or of 7-Scenes "
       "(frame-NNNNNN.depth.png).",
       "OUTPUT is a folder: trajectory/camera.txt and object_ID.txt, mesh/background.ply (world frame), object_ID.ply "
       "(closed, "
       "the object's frame) and object_ID_tsdf.ply (what was seen), summary.json."},
      {
          {"pcl_cosection_fusion --masks masks sequence out",
           "camera and objects are tracked; a mask now and then is enough"},
          {"pcl_cosection_fusion --segmentation geometric sequence out", "without masks: what stands on planes"},
          {"pcl_cosection_fusion --segmentation mask-rcnn --model net.onnx sequence out", "with a network of yours"},
          {"pcl_cosection_fusion kitchen room", "a room without objects"},
          {"pcl_cosection_fusion --config toys.txt toys out",
           "a simulated sequence with its true poses, with the options in toys.txt as below"},
          {"pcl_cosection_fusion --camera-trajectory cam.txt --masks masks sequence out",
           "given poses: objects without a trajectory are at rest"},
      },
      {"camera-trajectory = \"toys/gt-cam-0.txt\"", "masks = \"toys/mask\"",
       "object-trajectory = [\"1=toys/gt-truck-1.txt\", \"2=toys/gt-car-2.txt\"]"},
  };
  return (text);
}

void
declareFusionOptions (CLI::App& app, GivenFusion& given)
{
  declareInput (app, given);
  declareKnown (app, given);
  declareSegmentation (app, given);
  declareNetworkOptions (app, given.network);
  declareVolumeOptions (app, given, "0.02, or a 128th of a small scene");
  declareMethodOptions (app, given);
  declareRun (app, given);
}

std::optional<FusionSettings>
parseFusionCommandLine (int argc, const char* const* argv)
{
  GivenFusion given;
  CLI::App app;
  declareFusionOptions (app, given);
  if (!parseArguments (app, fusionText (), argc, argv))
    return (std::nullopt);
  try
  {
    preferCommandLine ({argv + 1, argv + argc}, given);
    return (toSettings (given));
  }
  catch (const InvalidArgument& error)
  {
    throw UsageError (error.what ());
  }
}
