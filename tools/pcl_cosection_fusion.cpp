// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Tracks and completes the objects of an RGB-D sequence; see pcl_cosection_fusion --help.

#include "export_report.h"
#include "fusion_command_line.h"
#include "fusion_outputs.h"
#include "live_view.h"
#include "method_json.h"
#include "run_program.h"

#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/sequence/pose_unit.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/trajectory.h>

#include <pcl/common/time.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

const char* const out_of_memory = "out of memory; use larger voxels (--voxel-size, --background-voxel-size), fewer "
                                  "views (--max-views) or threads (--threads)";

std::string
summaryLine (const ObjectResult& object, const std::optional<ClassScore>& best_class)
{
  std::ostringstream text;
  text.precision (3);
  text << "object " << object.id << ": ";
  if (best_class)
    text << classText (best_class->class_id, best_class->class_name, best_class->score) << ", ";
  text << object.mesh.vertices.size () << " vertices, " << 1000.0 * computeMassProperties (object.mesh).volume_m3
       << " litres, voxels of " << 1000.0 * object.signed_distance->grid.voxel_size_m << " mm";
  if (object.penetration_m > 0.0)
    text << ", " << 1000.0 * object.penetration_m << " mm inside another body";
  return (text.str ());
}

/** \brief A folder of masks, by its name, in that of a sequence; empty if there is none. */
std::string
unusedMasks (const std::string& dataset)
{
  std::set<std::string> found;
  std::error_code failure;
  for (fs::directory_iterator entry (dataset, failure); !failure && entry != fs::directory_iterator ();
       entry.increment (failure))
  {
    const std::string name = lowerCase (entry->path ().filename ().string ());
    const auto contains = [&name] (const char* word) { return (name.find (word) != name.npos); };
    std::error_code ignored;
    if ((contains ("mask") || contains ("instance") || contains ("label") || contains ("segm")) &&
        entry->is_directory (ignored))
      found.insert (entry->path ().string ());
  }
  return (found.empty () ? std::string () : *found.begin ());
}

/** \brief What goes in; it refers to itself. */
struct Inputs
{
  explicit Inputs (const FusionSettings& settings) : images (settings.dataset, settings.source)
  {
    warnings = images.warnings ();
    known.images = &images;
    if (settings.segmentation.empty ()) // which is done while tracking
      known.camera = settings.camera_trajectory.empty ()
                         ? images.givenTrajectory (warnings)
                         : loadTrajectory (settings.camera_trajectory, images.stamps ());
    for (const auto& [id, file] : settings.object_trajectories)
      known.objects[id] = loadTrajectory (file, images.stamps ());
    if (settings.masks.empty ())
    {
      const std::string folder = settings.segmentation.empty () ? unusedMasks (settings.dataset) : std::string ();
      if (!folder.empty ())
        warnings.push_back (folder + " is not used: give --masks " + folder + " if it has the objects' masks");
      return;
    }
    masks.emplace (settings.masks, images);
    known.masks = &*masks;
    warnings.insert (warnings.end (), masks->warnings ().begin (), masks->warnings ().end ());
  }

  Inputs (const Inputs&) = delete;
  Inputs& operator= (const Inputs&) = delete;

  RgbdSequence images;
  std::optional<MaskSequence> masks;
  KnownSequence known;
  std::vector<std::string> warnings;
};

/** \brief Where the poses of the camera are from. */
const std::string&
poseSource (const FusionSettings& settings)
{
  return (settings.camera_trajectory.empty () ? settings.dataset : settings.camera_trajectory);
}

SequenceFusion
makeFusion (const FusionSettings& settings, const Inputs& inputs)
{
  FusionOptions options = settings.fusion;
  const PinholeCamera& camera = inputs.images.camera ();
  if (!settings.ignored.empty ())
    options.ignored = ignoredPixels (settings.ignored, camera.width, camera.height);
  if (inputs.known.camera.empty ())
  {
    if (!inputs.known.objects.empty ())
      throw InvalidArgument ("--object-trajectory needs the poses of the camera: " + settings.dataset +
                             " has none; give --camera-trajectory FILE");
    TrackedSequence sequence (inputs.images, inputs.known.masks);
    if (!settings.segmentation.empty ())
      sequence.segmenter = makeSegmenter (settings.segmentation, settings.fusion.front_end.threads, settings.network);
    return (SequenceFusion (sequence, options));
  }
  if (settings.mask_ids == "per-frame")
    throw InvalidArgument (
        "with given poses, objects must have the same number in all masks, not --mask-ids per-frame");
  SequenceFusion fusion (inputs.known, options);
  if (const std::string fault = unitFault (inputs.known.camera, inputs.images, options.frames); !fault.empty ())
    throw InvalidArgument (poseSource (settings) + ": " + fault);
  return (fusion);
}

double
extentOf (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex);
  return (mesh.empty () ? 0.0 : box.diagonal ().norm ());
}

/** \brief A warning of an object that extends farther than the background, or than all others together where there is
 * none: the masks may have its number, or any but 0, where no object is. */
std::optional<std::string>
objectLikeBackground (const SceneResult& scene)
{
  const ObjectResult* largest = nullptr;
  double extent_m = 0.0, all_m = 0.0;
  for (const ObjectResult& object : scene.objects)
  {
    const double object_m = extentOf (object.mesh);
    all_m += object_m;
    if (object_m <= extent_m)
      continue;
    extent_m = object_m;
    largest = &object;
  }
  const double others_m = scene.background.empty () ? all_m - extent_m : extentOf (scene.background);
  const bool are_two = scene.objects.size () == 2 && scene.background.empty (); // one is always the larger
  if (others_m == 0.0 || extent_m <= (are_two ? 2.0 : 1.0) * others_m)
    return (std::nullopt);
  return ("object " + std::to_string (largest->id) + " extends farther than " +
          (scene.background.empty () ? "all others together" : "the background") +
          ": masks must be 0 where no object is");
}

/** \brief The stamps of given poses and of the frames, if frames are without a pose; else empty. */
std::string
stampsOfPoses (const FusionSettings& settings, const Inputs& inputs)
{
  const std::vector<StampedPose>& poses = inputs.known.camera;
  const FrameRange& range = settings.fusion.frames;
  std::vector<double> stamps = inputs.images.stamps ();
  stamps.resize (std::min (range.last, stamps.size ()));
  stamps.erase (stamps.begin (), stamps.begin () + static_cast<std::ptrdiff_t> (range.first));
  const auto of_frames = posesAtStamps (poses, stamps, inputs.images.period ());
  if (poses.empty () ||
      std::all_of (of_frames.begin (), of_frames.end (), [] (const auto& pose) { return pose.has_value (); }))
    return {};
  return ("; the poses of " + poseSource (settings) + " have the stamps " +
          stampSpan (poses.front ().stamp, poses.back ().stamp) + ", the frames " +
          stampSpan (stamps.front (), stamps.back ()) + "; they must be within half a frame of each other");
}

/** \brief Tell what became of the objects; errors become warnings of the summary. \return whether all went well */
bool
tellOutcome (const FusionSettings& settings, const Inputs& inputs, FusionResult& result, Terminal& terminal)
{
  bool all_good = true;
  for (const ObjectResult& object : result.scene.objects)
    if (object.error.empty ())
    {
      const auto fused = result.objects.find (object.id);
      terminal.result (summaryLine (object, fused == result.objects.end () ? std::nullopt : fused->second.best_class));
    }
  for (const std::string& failure : failureTexts (result.scene.objects))
  {
    all_good = false;
    result.warnings.push_back (failure);
    terminal.error (failure);
  }
  if (all_good && result.scene.background.empty () &&
      std::none_of (result.scene.objects.begin (), result.scene.objects.end (),
                    [] (const ObjectResult& object) { return (object.error.empty ()); }))
  {
    all_good = false;
    terminal.error ("nothing could be completed" +
                    (result.warnings.empty () ? std::string () : "; " + result.warnings.back ()));
  }
  if (!result.why_no_object.empty ())
  {
    all_good = false;
    terminal.error (result.why_no_object);
  }
  if (result.frames_left_out > result.frames)
  {
    all_good = false;
    result.warnings.push_back ("most frames were left out: " + std::to_string (result.frames_left_out) + " of " +
                               std::to_string (result.frames_left_out + result.frames) +
                               "; what was written is of the others alone" + stampsOfPoses (settings, inputs));
    terminal.error (result.warnings.back ());
  }
  return (all_good);
}

/** \return whether every object succeeded, and whether any did */
std::pair<bool, bool>
fuse (const FusionSettings& settings, FusionOutputs& outputs, Terminal& terminal)
{
  const pcl::StopWatch total;
  const Inputs inputs (settings);
  for (const std::string& warning : inputs.warnings)
    terminal.warning (warning);
  const SequenceFusion fusion = makeFusion (settings, inputs);
  std::optional<LiveView> live;
  const pcl::StopWatch opening;
  if (settings.live)
    live.emplace (settings.dataset, inputs.images.camera (), settings.output);
  const double window_s = opening.getTimeSeconds ();
  outputs.begin (); // not before the inputs are there: a slip of the pen costs nothing

  const auto report = [&] (const std::string& stage, double fraction) {
    terminal.progress (stage, fraction);
    return (!interrupted ());
  };
  std::map<std::string, int> lost_in_keyframes; // "object ID: reason", and how often
  const auto on_keyframe = [&] (const KeyframeReport& keyframe) {
    outputs.writeKeyframe (keyframe);
    for (const ObjectResult& object : keyframe.scene.objects)
      if (!object.error.empty ())
        ++lost_in_keyframes["object " + std::to_string (object.id) + ": " + object.error];
    if (live)
      live->show (keyframe);
  };
  SequenceFusion::FrameCallback on_frame;
  if (live)
    on_frame = [&live] (const FrameReport& frame) { live->show (frame); };
  FusionResult result = fusion.run (report, on_keyframe, on_frame);
  for (const auto& [reason, count] : lost_in_keyframes)
    result.warnings.push_back (reason + " (in " + std::to_string (count) + " of the written keyframes)");
  if (const auto warning = objectLikeBackground (result.scene))
    result.warnings.push_back (*warning);
  for (const std::string& warning : result.warnings)
    if (warning != result.why_no_object) // which is an error
      terminal.warning (warning);
  for (const std::string& event : result.events)
    terminal.detail (event);
  result.warnings.insert (result.warnings.begin (), inputs.warnings.begin (), inputs.warnings.end ());
  const bool all_good = tellOutcome (settings, inputs, result, terminal);

  const pcl::StopWatch writing;
  const std::vector<std::string> files = outputs.write (result);
  result.timings_s["write"] = writing.getTimeSeconds ();
  result.timings_s["total"] = total.getTimeSeconds () - window_s; // a window that opens is not yet the run
  outputs.writeSummary (result);
  for (const std::string& file : files)
    terminal.detail ("wrote " + file);
  std::ostringstream text;
  text.precision (3);
  text << "wrote " << settings.output << ": " << result.frames << " frames, " << result.keyframes << " keyframes, "
       << result.timings_s["total"] << " s";
  if (settings.masks.empty () && settings.segmentation.empty ())
    text << "; no objects, as neither --masks nor --segmentation is given";
  terminal.result (text.str ());
  for (const auto& [stage, seconds] : result.timings_s)
    terminal.detail (stage + ": " + std::to_string (seconds) + " s");
  return {all_good, anyCompleted (result.scene)};
}

bool
run (const FusionSettings& settings, Terminal& terminal)
{
  catchInterruptions ();
  FusionOutputs outputs (settings);
  bool all_good = false, any = false;
  try
  {
    std::tie (all_good, any) = fuse (settings, outputs, terminal);
  }
  catch (const Cancelled&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    outputs.writeFailure (describe (error, out_of_memory));
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
  return (runProgram ({"pcl_cosection_fusion", "interrupted; what was written is whole", out_of_memory}, argc, argv,
                      parseFusionCommandLine, run));
}
