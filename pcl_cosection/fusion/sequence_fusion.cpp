// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/sequence_fusion.h>

#include "frame_context.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double frames_share = 0.5; // of the progress; the rest is the last solution
constexpr std::size_t min_object_points = 100;
constexpr std::size_t status_every = 10;           // frames
constexpr std::chrono::milliseconds patience (50); // until a cancellation is noticed

/** \brief Check what is known before any frame is read. \throws InvalidArgument if there is no frame in the range, or
 * the ignored pixels are not of the images' size */
void
requireFrames (const RgbdSequence& images, const FusionOptions& options)
{
  const FrameRange& frames = options.frames;
  const Image<std::uint8_t>& ignored = options.ignored;
  const PinholeCamera& camera = images.camera ();
  if (!ignored.pixels.empty () && (ignored.width != camera.width || ignored.height != camera.height))
    throw InvalidArgument ("the image of ignored pixels has " + std::to_string (ignored.width) + " x " +
                           std::to_string (ignored.height) + " pixels; the images of the sequence have " +
                           std::to_string (camera.width) + " x " + std::to_string (camera.height));
  if (frames.first >= std::min (frames.last, images.size ()))
    throw InvalidArgument ("the frames from " + std::to_string (frames.first) +
                           " on are not there; the sequence has 0:" + std::to_string (images.size ()));
}

/** \throws InvalidArgument if no frame of the range has a pose of the camera */
void
requirePoses (const KnownSequence& sequence, const FrameRange& frames)
{
  const std::vector<double> stamps = sequence.images->stamps ();
  const std::vector<double> used (stamps.begin () + static_cast<std::ptrdiff_t> (frames.first),
                                  stamps.begin () +
                                      static_cast<std::ptrdiff_t> (std::min (frames.last, stamps.size ())));
  const auto poses = posesAtStamps (sequence.camera, used, sequence.images->period ());
  if (std::none_of (poses.begin (), poses.end (), [] (const auto& pose) { return pose.has_value (); }))
    throw InvalidArgument ("the camera's trajectory has no pose for any frame: its stamps are " +
                           stampSpan (sequence.camera.front ().stamp, sequence.camera.back ().stamp) +
                           ", those of the frames " + stampSpan (used.front (), used.back ()) +
                           "; they must be within half a frame of each other");
}

/** \brief Passes on how far a run is. */
class RunProgress
{
public:
  RunProgress (const ProgressCallback& callback, const FrameRange& frames, std::size_t size)
      : callback_ (callback)
      , first_ (frames.first)
      , frames_ (std::min (frames.last, size) - std::min (frames.first, size))
  {}

  /** \throws Cancelled */
  void report (const std::string& stage, double fraction) const
  {
    if (callback_ && !callback_ (stage, std::min (1.0, fraction)))
      throw Cancelled ("cancelled");
  }

  /** \brief A frame was read. \throws Cancelled */
  void reportFrame (std::size_t index, const FrameContext& context)
  {
    done_ = frames_share * static_cast<double> (index - first_) /
            static_cast<double> (std::max<std::size_t> (1, frames_));
    if (frames_read_ > 0 && frames_read_ % status_every == 0)
    {
      const auto now = std::chrono::steady_clock::now ();
      const double seconds = std::max (1e-3, std::chrono::duration<double> (now - status_time_).count ());
      std::array<char, 32> rate;
      std::snprintf (rate.data (), rate.size (), "%.1f fps", static_cast<double> (status_every) / seconds);
      const std::string of_frame = context.status ();
      status_ = rate.data () + (of_frame.empty () ? "" : ", " + of_frame);
      status_time_ = now;
    }
    report (status_, done_);
    ++frames_read_;
  }

  /** \brief The back end has completed a keyframe, or is doing so. \throws Cancelled */
  void reportKeyframe () const { report ("keyframe", done_); }

  std::size_t framesRead () const { return frames_read_; }

private:
  const ProgressCallback& callback_;
  std::size_t first_;
  std::size_t frames_; // of the range
  std::size_t frames_read_ = 0;
  double done_ = 0.0; // of all
  std::string status_ = "frames";
  std::chrono::steady_clock::time_point status_time_ = std::chrono::steady_clock::now ();
};

/** \brief The back end, in a thread beside the front end if there are updates at keyframes. */
class RunBackend
{
public:
  explicit RunBackend (const FusionOptions& options) : backend_ (options.backend)
  {
    if (options.updates != KeyframeUpdates::None)
      thread_.emplace (backend_);
  }

  void addKeyframe (Keyframe keyframe, const CoSectionBackend::Poses& T_world_object)
  {
    if (thread_)
      thread_->addKeyframe (std::move (keyframe), T_world_object);
    else
      backend_.addKeyframe (keyframe, T_world_object);
  }

  void addFrame (DepthView view, const CoSectionBackend::Poses& T_world_object)
  {
    if (thread_)
      thread_->addFrame (std::move (view), T_world_object);
    else
      backend_.addFrame (std::move (view), T_world_object);
  }

  /** \brief Pass updates on, when no more than so many views wait for the back end; 0: when all updates are done. */
  void followUpdates (std::size_t waiting_views, const RunProgress& progress,
                      const SequenceFusion::KeyframeCallback& callback, double& seconds)
  {
    if (!thread_)
      return;
    while (!thread_->wait (waiting_views, patience))
      progress.reportKeyframe ();
    for (const BackendUpdate& update : thread_->takeUpdates ())
    {
      seconds += update.seconds;
      progress.reportKeyframe ();
      if (callback)
        callback ({update.stamp, update.scene});
    }
  }

  /** \brief The back end with all views, as if there had been no updates. */
  CoSectionBackend& withoutUpdates ()
  {
    thread_.reset ();
    backend_.forgetUpdates ();
    return backend_;
  }

private:
  CoSectionBackend backend_;
  std::optional<BackendThread> thread_;
};

/** \brief Numbers of points in all keyframes. */
struct KeyframePoints
{
  std::size_t all = 0;
  std::size_t without_pose = 0; ///< of objects whose pose is not known in the keyframe
};

void
countPoints (const Keyframe& keyframe, const CoSectionBackend::Poses& T_world_object,
             std::map<int, FusedObject>& objects, KeyframePoints& points)
{
  for (const auto& [id, of_object] : keyframe.points)
  {
    points.all += of_object.size ();
    if (id == 0)
      continue;
    if (T_world_object.count (id) > 0)
      objects[id].points += of_object.size ();
    else
      points.without_pose += of_object.size ();
  }
}

FusionResult
emptyResult (const RgbdSequence& images, const FrameRange& frames)
{
  FusionResult result;
  for (const char* stage : {"read", "tracking", "raycast", "segmentation", "integration", "keyframes", "updates"})
    result.timings_s[stage] = 0.0;
  result.intrinsics = images.camera ();
  if (frames.last > images.size () && frames.last != FrameRange ().last)
    result.warnings.push_back ("frames from " + std::to_string (images.size ()) +
                               " on are not there; the sequence has 0:" + std::to_string (images.size ()));
  return result;
}

/** \brief The next frame, without readings where pixels are ignored; nothing at the end. */
std::optional<RgbdFrame>
readFrame (FrameReader& reader, const Image<std::uint8_t>& ignored, double& seconds)
{
  const ScopedSeconds timer (seconds);
  std::optional<RgbdFrame> frame = reader.next ();
  for (std::size_t n = 0; frame && n < ignored.pixels.size (); ++n)
    if (ignored.pixels[n] != 0)
      frame->depth.pixels[n] = std::numeric_limits<float>::quiet_NaN ();
  return frame;
}

/** \brief Add the warnings of readers. \throws IoError if no frame could be used */
void
requireKeyframes (std::size_t frames_read, std::size_t points, const std::vector<std::string>& frame_warnings,
                  const FrameContext& context, const FusionOptions& options, FusionResult& result)
{
  const std::vector<std::string> mask_warnings = context.maskWarnings ();
  const auto firstOf = [] (const std::vector<std::string>& lines) {
    return lines.empty () ? std::string () : ": " + lines.front ();
  };
  result.warnings.insert (result.warnings.end (), frame_warnings.begin (), frame_warnings.end ());
  result.warnings.insert (result.warnings.end (), mask_warnings.begin (), mask_warnings.end ());
  if (result.frames == 0)
    throw IoError ((frames_read == 0 ? "no frame can be read" : "no frame that has a pose can be read") +
                   firstOf (frame_warnings));
  if (result.keyframes == 0 || context.lacksMasks ())
    throw IoError ("no frame has a mask that can be used" + firstOf (mask_warnings));
  if (points == 0)
  {
    std::ostringstream text;
    text << "no keyframe has a surface nearer than " << options.keyframe.max_depth_m << " m"
         << firstOf (frame_warnings);
    throw IoError (text.str ());
  }
}

/** \brief Leave out objects of too few points, which are no failure: masks have outliers. */
void
leaveOutSmallObjects (FusionResult& result)
{
  for (auto object = result.objects.begin (); object != result.objects.end ();)
  {
    const std::size_t points = object->second.points;
    if (points >= min_object_points)
    {
      ++object;
      continue;
    }
    if (points > 0)
      result.warnings.push_back ("object " + std::to_string (object->first) + " was left out: it has only " +
                                 std::to_string (points) + " points in all keyframes; " +
                                 std::to_string (min_object_points) + " are needed");
    object = eraseObject (object, false, result);
  }
}

/** \brief Complete everything from all views. */
void
completeSequence (CoSectionBackend& backend, const RunProgress& progress, FrameContext& context,
                  std::size_t points_without_pose, FusionResult& result)
{
  for (const int id : context.wrongObjects ())
    backend.removeObject (id);
  {
    const ScopedSeconds timer (result.timings_s["final_solve"]);
    result.scene = backend.solve ([&] (const std::string& stage, double fraction) {
      progress.report (stage, frames_share + (1.0 - frames_share) * fraction);
      return true;
    });
  }
  for (const auto& [stage, seconds] : result.scene.timings_s)
    result.timings_s[stage] += seconds;
  result.kept_keyframes = backend.keyframes ();
  context.finish (result);
  if (points_without_pose > 0)
    result.warnings.push_back (std::to_string (points_without_pose) +
                               " points of objects were left out: their trajectories have no pose for those frames");
  leaveOutSmallObjects (result);
  result.warnings.insert (result.warnings.end (), result.scene.warnings.begin (), result.scene.warnings.end ());
}

} // namespace

FusionOptions::FusionOptions ()
{
  backend.method.whole_background = true;
  backend.method.min_points = min_object_points;
  tsdf.tsdf.colour = true;
}

void
FusionOptions::validate () const
{
  backend.validate ();
  keyframe.validate ();
  tsdf.validate ();
  front_end.validate ();
  if (keyframe_every < 1)
    throw InvalidArgument ("keyframe_every must be at least 1");
}

SequenceFusion::SequenceFusion (KnownSequence sequence, const FusionOptions& options)
    : sequence_ (std::move (sequence))
    , options_ (options)
{
  options.validate ();
  if (!sequence_.images)
    throw InvalidArgument ("there are no images");
  if (sequence_.camera.empty ())
    throw InvalidArgument ("there is no pose of the camera");
  requireFrames (*sequence_.images, options_);
  requirePoses (sequence_, options_.frames);
}

SequenceFusion::SequenceFusion (const TrackedSequence& sequence, const FusionOptions& options)
    : tracked_ (sequence)
    , options_ (options)
{
  if (sequence.segmenter && sequence.segmenter->isExact ()) // what it finds was background until then
    options_.backend.method.leave_out_moved = true;
  options.validate ();
  requireFrames (*sequence.images, options_);
}

FusionResult
SequenceFusion::run (const ProgressCallback& progress, const KeyframeCallback& on_keyframe,
                     const FrameCallback& on_frame) const
{
  const RgbdSequence& images = tracked_ ? *tracked_->images : *sequence_.images;
  const std::unique_ptr<FrameContext> context = tracked_ ? makeTrackedPoses (*tracked_, options_)
                                                         : makeKnownPoses (sequence_, options_);
  const auto every = static_cast<std::size_t> (options_.keyframe_every);
  FusionResult result = emptyResult (images, options_.frames);
  KeyframePoints points;
  RunProgress run_progress (progress, options_.frames, images.size ());
  RunBackend backend (options_);
  FrameReader reader (images, options_.frames);
  std::optional<std::size_t> next_keyframe;
  while (const auto frame = readFrame (reader, options_.ignored, result.timings_s["read"]))
  {
    run_progress.reportFrame (frame->index, *context);

    // Poses and instances of the frame.
    const FrameKnowns known = context->next (*frame);
    if (!known.T_world_camera)
      continue;
    ++result.frames;
    result.camera.push_back ({frame->stamp, *known.T_world_camera});

    // Points of the frame, if a keyframe is due. It waits for a mask for as long as one may still come.
    const std::size_t due = next_keyframe.value_or (frame->index);
    const bool is_keyframe = frame->index >= due && known.instances && (known.masked || frame->index - due >= every);
    next_keyframe = is_keyframe ? due + (frame->index - due) / every * every + every : due;
    std::optional<Keyframe> keyframe;
    if (const ScopedSeconds timer (result.timings_s["keyframes"]); is_keyframe)
      keyframe = makeKeyframe (*frame, images.camera (), *known.instances, *known.T_world_camera, options_.keyframe);

    // Surfaces and trajectories of objects.
    const CoSectionBackend::Poses T_world_object = context->mapObjects (*frame, known, keyframe ? &*keyframe : nullptr);
    for (const auto& [id, T] : T_world_object)
      result.objects[id].trajectory.push_back ({frame->stamp, T});

    // Points and free space for the completion.
    if (keyframe)
    {
      ++result.keyframes;
      countPoints (*keyframe, T_world_object, result.objects, points);
    }
    if (const ScopedSeconds timer (result.timings_s["keyframes"]); keyframe)
      backend.addKeyframe (std::move (*keyframe), T_world_object);
    else
      backend.addFrame (makeDepthView (frame->depth, images.camera (), *known.T_world_camera, options_.keyframe),
                        T_world_object);

    if (on_frame)
      on_frame ({*frame, *known.T_world_camera, T_world_object, known.instances ? &*known.instances : nullptr,
                 is_keyframe, [&] (int id) { return context->surfaceMesh (id); }});
    backend.followUpdates (is_keyframe && options_.updates == KeyframeUpdates::InStep ? 0 : options_.backend.max_views,
                           run_progress, on_keyframe, result.timings_s["updates"]);
  }
  requireKeyframes (run_progress.framesRead (), points.all, reader.warnings (), *context, options_, result);
  result.frames_left_out = std::min (options_.frames.last, images.size ()) - options_.frames.first - result.frames;
  backend.followUpdates (0, run_progress, on_keyframe, result.timings_s["updates"]);
  completeSequence (backend.withoutUpdates (), run_progress, *context, points.without_pose, result);
  return result;
}

} // namespace pcl::cosection
