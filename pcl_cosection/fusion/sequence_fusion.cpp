// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/fusion/sequence_fusion.h>

#include "frame_check.h"
#include "frame_context.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/co_section_backend.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr double frames_share = 0.5; // of the progress; the rest is the last solution
constexpr std::size_t min_object_points = 100;
constexpr std::size_t status_every = 10;           // frames
constexpr std::chrono::milliseconds patience (50); // until a cancellation is heard

/** \brief One execution of SequenceFusion::run (). */
class FusionRun
{
public:
  FusionRun (const RgbdSequence& images, FrameContext& knowledge, const FusionOptions& options,
             const ProgressCallback& progress, const SequenceFusion::KeyframeCallback& report,
             const SequenceFusion::FrameCallback& report_frame);

  FusionResult run ();

private:
  void report (const std::string& stage, double fraction) const;
  /** \brief Say how it goes. */
  void reportFrame (const RgbdFrame& frame);
  void use (const RgbdFrame& frame);
  void addKeyframe (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera);
  void addFrame (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera);
  /** \brief Pass updates on, once no more than so many views wait for the back end; 0: once all that were asked for are
   * done. */
  void followUpdates (std::size_t waiting_views);
  void finish ();
  /** \brief Those with too few points, which are no failure: masks have outlier pixels. */
  void leaveOutSmallObjects ();
  template <typename Function> void timed (const char* stage, Function&& f)
  {
    addSeconds (result_.timings_s[stage], f);
  }

  const RgbdSequence& images_;
  FrameContext& knowledge_;
  const FusionOptions& options_;
  const ProgressCallback& progress_;
  const SequenceFusion::KeyframeCallback& report_;
  const SequenceFusion::FrameCallback& report_frame_;
  FusionResult result_;
  CoSectionBackend backend_;
  std::optional<BackendThread> thread_; // has the backend, if there are updates
  std::size_t frames_of_range_ = 0;
  double done_ = 0.0; // of all, so far
  std::size_t frames_read_ = 0;
  std::string status_ = "frames";
  std::chrono::steady_clock::time_point status_time_ = std::chrono::steady_clock::now ();
  std::size_t points_without_pose_ = 0;
  std::size_t points_ = 0; // in all keyframes
  std::optional<std::size_t> next_keyframe_;
};

FusionRun::FusionRun (const RgbdSequence& images, FrameContext& knowledge, const FusionOptions& options,
                      const ProgressCallback& progress, const SequenceFusion::KeyframeCallback& report,
                      const SequenceFusion::FrameCallback& report_frame)
    : images_ (images)
    , knowledge_ (knowledge)
    , options_ (options)
    , progress_ (progress)
    , report_ (report)
    , report_frame_ (report_frame)
    , backend_ (options.backend)
{
  frames_of_range_ = std::min (options.frames.last, images.size ()) - std::min (options.frames.first, images.size ());
  for (const char* stage : {"read", "tracking", "raycast", "segmentation", "integration", "keyframes", "updates"})
    result_.timings_s[stage] = 0.0;
  result_.intrinsics = images.camera ();
  if (options.updates != KeyframeUpdates::None)
    thread_.emplace (backend_);
}

void
FusionRun::report (const std::string& stage, double fraction) const
{
  if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
    throw Cancelled ("cancelled");
}

void
FusionRun::reportFrame (const RgbdFrame& frame)
{
  done_ = frames_share * static_cast<double> (frame.index - options_.frames.first) /
          static_cast<double> (std::max<std::size_t> (1, frames_of_range_));
  if (frames_read_ > 0 && frames_read_ % status_every == 0)
  {
    const auto now = std::chrono::steady_clock::now ();
    const double seconds = std::max (1e-3, std::chrono::duration<double> (now - status_time_).count ());
    std::array<char, 32> rate;
    std::snprintf (rate.data (), rate.size (), "%.1f fps", static_cast<double> (status_every) / seconds);
    const std::string of_frame = knowledge_.status ();
    status_ = rate.data () + (of_frame.empty () ? "" : ", " + of_frame);
    status_time_ = now;
  }
  report (status_, done_);
  ++frames_read_;
}

void
FusionRun::addKeyframe (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera)
{
  Keyframe keyframe = makeKeyframe (frame, images_.camera (), *knowledge_.instances (), T_world_camera,
                                    options_.keyframe);
  knowledge_.look (keyframe);
  const CoSectionBackend::Poses T_world_object = knowledge_.poses ();
  for (const auto& [id, points] : keyframe.points)
  {
    points_ += points.size ();
    if (id == 0)
      continue;
    if (T_world_object.count (id) > 0)
      result_.objects[id].points += points.size ();
    else
      points_without_pose_ += points.size ();
  }
  ++result_.keyframes;
  if (thread_)
    thread_->addKeyframe (std::move (keyframe), T_world_object);
  else
    backend_.addKeyframe (keyframe, T_world_object);
}

void
FusionRun::addFrame (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera)
{
  DepthView view = makeDepthView (frame.depth, images_.camera (), T_world_camera, options_.keyframe);
  if (thread_)
    thread_->addFrame (std::move (view), knowledge_.poses ());
  else
    backend_.addFrame (std::move (view), knowledge_.poses ());
}

void
FusionRun::followUpdates (std::size_t waiting_views)
{
  if (!thread_)
    return;
  while (!thread_->wait (waiting_views, patience))
    report ("keyframe", done_);
  for (const BackendUpdate& update : thread_->takeUpdates ())
  {
    result_.timings_s["updates"] += update.seconds;
    report ("keyframe", done_);
    if (report_)
      report_ ({update.stamp, update.scene});
  }
}

void
FusionRun::use (const RgbdFrame& frame)
{
  const std::optional<Eigen::Isometry3d> T_world_camera = knowledge_.next (frame);
  if (!T_world_camera)
    return;
  ++result_.frames;
  result_.camera.push_back ({frame.stamp, *T_world_camera});
  if (!next_keyframe_)
    next_keyframe_ = frame.index;

  const bool is_keyframe = frame.index >= *next_keyframe_ &&
                           knowledge_.isFitForKeyframe (frame.index - *next_keyframe_);
  if (is_keyframe)
  {
    timed ("keyframes", [&] { addKeyframe (frame, *T_world_camera); });
    while (*next_keyframe_ <= frame.index)
      *next_keyframe_ += static_cast<std::size_t> (options_.keyframe_every);
  }
  const CoSectionBackend::Poses T_world_object = knowledge_.poses ();
  for (const auto& [id, T] : T_world_object)
    result_.objects[id].trajectory.push_back ({frame.stamp, T});
  if (!is_keyframe)
    timed ("keyframes", [&] { addFrame (frame, *T_world_camera); });
  knowledge_.map (frame, *T_world_camera);
  if (report_frame_)
  {
    const auto& instances = knowledge_.instances ();
    report_frame_ ({frame, *T_world_camera, T_world_object, instances ? &*instances : nullptr, is_keyframe,
                    [this] (int id) { return knowledge_.seen (id); }});
  }
  followUpdates (is_keyframe && options_.updates == KeyframeUpdates::InStep ? 0 : options_.backend.max_views);
}

void
FusionRun::finish ()
{
  followUpdates (0);
  thread_.reset ();
  backend_.forgetUpdates ();
  for (const int id : knowledge_.wrongObjects ())
    backend_.removeObject (id);
  timed ("final_solve", [&] {
    result_.scene = backend_.solve ([&] (const std::string& stage, double fraction) {
      report (stage, frames_share + (1.0 - frames_share) * fraction);
      return true;
    });
  });
  for (const auto& [stage, seconds] : result_.scene.timings_s)
    result_.timings_s[stage] += seconds;
  result_.kept_keyframes = backend_.keyframes ();
  knowledge_.finish (result_);
  if (points_without_pose_ > 0)
    result_.warnings.push_back (std::to_string (points_without_pose_) +
                                " points of objects were left out: their trajectories have no pose for those frames");
  leaveOutSmallObjects ();
  result_.warnings.insert (result_.warnings.end (), result_.scene.warnings.begin (), result_.scene.warnings.end ());
}

void
FusionRun::leaveOutSmallObjects ()
{
  for (auto object = result_.objects.begin (); object != result_.objects.end ();)
  {
    const auto& [id, fused] = *object;
    if (fused.points >= min_object_points)
    {
      ++object;
      continue;
    }
    if (fused.points > 0)
      result_.warnings.push_back ("object " + std::to_string (id) + " was left out: it has only " +
                                  std::to_string (fused.points) + " points in all keyframes; " +
                                  std::to_string (min_object_points) + " are needed");
    auto& completed = result_.scene.objects;
    completed.erase (
        std::remove_if (completed.begin (), completed.end (),
                        [id = id] (const ObjectResult& result) { return result.id == id && !result.error.empty (); }),
        completed.end ());
    object = result_.objects.erase (object);
  }
}

FusionResult
FusionRun::run ()
{
  if (options_.frames.last > images_.size () && options_.frames.last != FrameRange ().last)
    result_.warnings.push_back ("frames from " + std::to_string (images_.size ()) +
                                " on are not there; the sequence has 0:" + std::to_string (images_.size ()));
  FrameReader reader (images_, options_.frames);
  while (true)
  {
    std::optional<RgbdFrame> frame;
    timed ("read", [&] { frame = reader.next (); });
    if (!frame)
      break;
    for (std::size_t n = 0; n < options_.ignored.pixels.size (); ++n)
      if (options_.ignored.pixels[n] != 0)
        frame->depth.pixels[n] = std::numeric_limits<float>::quiet_NaN ();
    reportFrame (*frame);
    use (*frame);
  }
  const std::vector<std::string> mask_warnings = knowledge_.maskWarnings ();
  const std::vector<std::string> warnings = reader.warnings ();
  const auto firstOf = [] (const std::vector<std::string>& lines) {
    return lines.empty () ? std::string () : ": " + lines.front ();
  };
  result_.warnings.insert (result_.warnings.end (), warnings.begin (), warnings.end ());
  result_.warnings.insert (result_.warnings.end (), mask_warnings.begin (), mask_warnings.end ());
  if (result_.frames == 0)
    throw IoError ((frames_read_ == 0 ? "no frame can be read" : "no frame that has a pose can be read") +
                   firstOf (warnings));
  if (result_.keyframes == 0)
    throw IoError ("no frame has a mask that can be used" + firstOf (mask_warnings));
  if (points_ == 0)
  {
    std::ostringstream text;
    text << "no keyframe has a surface nearer than " << options_.keyframe.max_depth_m << " m" << firstOf (warnings);
    throw IoError (text.str ());
  }
  finish ();
  return std::move (result_);
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
SequenceFusion::run (const ProgressCallback& progress, const KeyframeCallback& keyframe,
                     const FrameCallback& frame) const
{
  const std::unique_ptr<FrameContext> knowledge = tracked_ ? makeTrackedPoses (*tracked_, options_)
                                                           : makeKnownPoses (sequence_, options_);
  const RgbdSequence& images = tracked_ ? *tracked_->images : *sequence_.images;
  return FusionRun (images, *knowledge, options_, progress, keyframe, frame).run ();
}

} // namespace pcl::cosection
