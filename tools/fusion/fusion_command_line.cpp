// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fusion_command_line.h"

#include "export_report.h"
#include "option_values.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

constexpr double coarsest_tracking_voxel_m = 0.02; // coarser ones lose small objects
constexpr double last_number = 1e12;               // of a frame

void
declareInput (CLI::App& app, GivenFusion& given)
{
  OptionGroup input (app, "Input");
  input.add ("--format cofusion|tum|7scenes", given.format, "Layout of DATASET (default: found out)");
  input.add ("--depth-dir NAME", given.depth_dir, "Folder of the depth images (default: depth_noise, else depth)");
  input.add ("--depth-scale FACTOR", given.depth_scale, positiveNumber (),
             "Units of a depth PNG per metre (default: 5000 for the layout tum, else 1000)");
  input.add ("--intrinsics FX,FY,CX,CY", given.intrinsics, "Camera in pixels, instead of calibration.txt");
  input.add ("--frames A:B", given.frames, "Only the frames from A up to but without B, counted from 0 (default: all)");
  declareIgnoredArea (app, given.given_area);
  input.add ("--max-depth METRES", given.max_depth, positiveNumber (),
             "Leave out readings that are farther away (default: 10)");
}

void
declareKnown (CLI::App& app, GivenFusion& given)
{
  OptionGroup known (app, "Known");
  known.add ("--camera-trajectory FILE", given.camera_trajectory,
             "Poses of the camera in the world: lines \"stamp tx ty tz qx qy qz qw\" (default: those that come with "
             "the images; without, camera and objects are tracked)");
  known.add (
      "--object-trajectory ID=FILE", given.trajectory_values,
      "Poses of object ID in the world, beside those of the camera; repeatable. Objects without one are at rest");
  known.add ("--masks DIR", given.masks,
             "Folder of PNGs of 8 or 16 bits, one per frame that has one: pixel = number of an object, 0 = background "
             "(default: there are no objects)");
  known.add (
      "--mask-ids persistent|per-frame", given.mask_ids,
      "Whether an object has the same number in all masks (default: persistent with given poses, else per-frame)");
  known.add ("--segmentation geometric|motion|mask-rcnn", given.segmentation,
             "Find the objects in every tenth frame instead of reading masks; geometric: what stands on planes; "
             "motion: what has begun to move; mask-rcnn: with a network");
}

void
declareRun (CLI::App& app, GivenFusion& given)
{
  OptionGroup sequence (app, "Sequence");
  sequence.add ("--keyframe-every N", given.keyframe_every, wholeRange (1, 1000000),
                "Take the points of every N-th frame; of the others, free space (default: 10)");
  sequence.add ("--max-views N", given.max_views, wholeRange (4, 100000),
                "Keep at most so many depth images; those most like others are given up (default: 100)");
  sequence.addFlag ("--save-keyframes", given.save_keyframes,
                    "Complete everything at keyframes too, beside the tracking, and write it to keyframes/STAMP/; of "
                    "keyframes that come meanwhile the last");
  sequence.addFlag ("--deterministic", given.deterministic,
                    "With --save-keyframes, wait for each keyframe, so that all are written; the last result is the "
                    "same in any case");
  sequence.addFlag ("--live", given.live,
                    "Show it in a window while it runs, and the result then; without influence on that");
  OptionGroup general (app, "General");
  general.add ("--json FILE", given.json, "Write the summary to this file as well");
  declareExport (general, given.exports);
}

void
setPaths (FusionSettings& settings)
{
  requirePaths (settings.paths, "DATASET", "OUTPUT");
  settings.dataset = settings.paths[0];
  settings.output = settings.paths[1];
  if (settings.dataset.empty () || settings.output.empty ())
    throw UsageError (std::string (settings.dataset.empty () ? "DATASET" : "OUTPUT") +
                      " is empty; it must be a folder");
}

void
setSource (FusionSettings& settings)
{
  SequenceSource& source = settings.source;
  if (!settings.format.empty ())
    source.format = settings.format == "cofusion" ? SequenceFormat::CoFusion
                    : settings.format == "tum"    ? SequenceFormat::Tum
                                                  : SequenceFormat::SevenScenes;
  source.depth_folder = settings.depth_dir;
  source.depth_scale = settings.depth_scale.value_or (0.0);
  source.intrinsics = parseIntrinsics (settings.intrinsics);
}

void
setObjects (FusionSettings& settings)
{
  settings.object_trajectories = parseObjectFiles ("--object-trajectory", settings.trajectory_values);
  if (!settings.object_trajectories.empty () && settings.masks.empty ())
    throw UsageError ("--object-trajectory needs --masks, which show the objects' pixels");
  if (!settings.mask_ids.empty () && settings.masks.empty ())
    throw UsageError ("--mask-ids needs --masks");
  if (!settings.object_trajectories.empty () && settings.mask_ids == "per-frame")
    throw UsageError ("--object-trajectory needs objects with the same number in all masks, not --mask-ids per-frame");
  settings.ignored = ignoredArea (settings.given_area);
  if (!settings.segmentation.empty () && !settings.masks.empty ())
    throw UsageError ("--masks and --segmentation exclude each other");
  if (!settings.segmentation.empty () && !settings.camera_trajectory.empty ())
    throw UsageError ("--segmentation needs tracking: it excludes --camera-trajectory");
  const std::string of_network = anyNetworkOption (settings.given_network);
  if (settings.segmentation == "mask-rcnn")
  {
    if (settings.given_network.model.empty ())
      throw UsageError ("--segmentation mask-rcnn needs a network: --model FILE");
    settings.network = networkSettings (settings.given_network);
  }
  else if (!of_network.empty ())
    throw UsageError (of_network + " needs --segmentation mask-rcnn");
}

void
interpret (FusionSettings& settings)
{
  setPaths (settings);
  setSource (settings);
  setObjects (settings);
  FusionOptions& fusion = settings.fusion;
  const CoSectionOptions defaults = fusion.backend.method;
  fusion.backend.method = methodOptions (settings);
  fusion.backend.method.whole_background = defaults.whole_background;
  fusion.backend.method.min_points = defaults.min_points;
  override (fusion.backend.method.background_block_vox, settings.background_block);
  if (!settings.frames.empty ())
  {
    const FrameSpan frames = parseFrames (settings.frames, last_number);
    fusion.frames = {frames.first, frames.last.value_or (fusion.frames.last)};
  }
  override (fusion.keyframe_every, settings.keyframe_every);
  override (fusion.keyframe.max_depth_m, settings.max_depth);
  fusion.front_end.max_depth_m = fusion.keyframe.max_depth_m;
  if (settings.background_voxel_size)
    fusion.front_end.background_voxel_size_m = std::min (*settings.background_voxel_size, coarsest_tracking_voxel_m);
  fusion.front_end.persistent_ids = settings.mask_ids == "persistent";
  fusion.keyframe.threads = settings.threads;
  fusion.tsdf.tsdf.threads = settings.threads;
  fusion.front_end.threads = settings.threads;
  if (settings.save_keyframes)
    fusion.updates = settings.deterministic ? KeyframeUpdates::InStep : KeyframeUpdates::Beside;
  if (settings.max_views)
  {
    fusion.backend.max_views = static_cast<std::size_t> (*settings.max_views);
    fusion.backend.max_keyframes = std::max<std::size_t> (
        2, std::min (fusion.backend.max_keyframes, fusion.backend.max_views - 1));
  }
  settings.source.validate ();
  fusion.validate ();
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
       "(closed, the object's frame) and object_ID_tsdf.ply (what was seen), summary.json."},
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
  declareNetworkOptions (app, given.given_network);
  declareVolumeOptions (app, given, "0.02, or a 128th of a small scene");
  OptionGroup (app, "Volume")
      .add ("--background-block VOXELS", given.background_block, wholeRange (32, 1024),
            "Edge of the largest volume of the background; what needs more than its cube is solved in blocks" +
                byDefault (256));
  declareMethodOptions (app, given);
  declareRun (app, given);
  declareGeneralOptions (app, "pcl_cosection_fusion", given);
}

std::optional<FusionSettings>
parseFusionCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<FusionSettings> (argc, argv, fusionText (), declareFusionOptions, interpret));
}

std::shared_ptr<FrameSegmenter>
makeSegmenter (const std::string& name, int threads, const std::optional<NetworkSettings>& network)
{
  if (name == "geometric")
  {
    ObjectSegmentationOptions options;
    options.threads = threads;
    return (std::make_shared<GeometricSegmenter> (options));
  }
  if (name == "motion")
  {
    MotionSegmentationOptions options;
    options.threads = threads;
    return (std::make_shared<MotionSegmenter> (options));
  }
  if (name == "mask-rcnn" && network)
  {
    NetworkSettings settings = *network;
    readClassNames (settings);
    return (std::make_shared<NetworkSegmenter> (settings.network, settings.roles));
  }
  throw InvalidArgument ("there is no segmentation of the name " + name);
}
