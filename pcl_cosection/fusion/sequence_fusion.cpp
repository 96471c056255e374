// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/sequence_fusion.h>

#include "camera_size.h"
#include "fusion_run.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double frames_share = 0.5; // of the progress; the rest is the last solution
constexpr std::size_t min_object_points = 100;
constexpr std::size_t status_every = 10; // frames

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

private:
  const ProgressCallback& callback_;
  std::size_t first_;
  std::size_t frames_; // of the range
  std::size_t frames_read_ = 0;
  double done_ = 0.0; // of all
  std::string status_ = "frames";
  std::chrono::steady_clock::time_point status_time_ = std::chrono::steady_clock::now ();
};

/** \brief Warn of frames that were asked for and are not there. */
void
warnOfRange (const RgbdSequence& images, const FrameRange& frames, FusionResult& result)
{
  if (frames.last > images.size () && frames.last != FrameRange ().last)
    result.warnings.push_back ("frames from " + std::to_string (images.size ()) +
                               " on are not there; the sequence has 0:" + std::to_string (images.size ()));
}

/** \brief Take the readings of pixels that are ignored. */
void
leaveOut (const Image<std::uint8_t>& ignored, RgbdFrame& frame)
{
  for (std::size_t n = 0; n < ignored.pixels.size (); ++n)
    if (ignored.pixels[n] != 0)
      frame.depth.pixels[n] = std::numeric_limits<float>::quiet_NaN ();
}

/** \brief What was read. */
struct FrameReadings
{
  std::size_t frames = 0;
  float nearest_m = std::numeric_limits<float>::infinity (); ///< reading

  void add (const Image<float>& depth)
  {
    ++frames;
    for (const float z : depth.pixels)
      if (isReading (z))
        nearest_m = std::min (nearest_m, z);
  }
};

/** \brief The next frame, without readings where pixels are ignored; nothing at the end. */
std::optional<RgbdFrame>
readFrame (FrameReader& reader, const Image<std::uint8_t>& ignored, double& seconds)
{
  const ScopedSeconds timer (seconds);
  std::optional<RgbdFrame> frame = reader.next ();
  if (frame)
    leaveOut (ignored, *frame);
  return frame;
}

/** \brief The reason in the first of some warnings, after a colon: without what was done with the frame, as nothing
 * comes of the run. */
std::string
firstReason (const std::vector<std::string>& warnings)
{
  if (warnings.empty ())
    return {};
  return ": " + warnings.front ().substr (0, warnings.front ().rfind ("; the frame is "));
}

/** \brief Why no frame of a run is used. */
std::string
whyNoFrame (const FrameReadings& readings, bool tracked, const FusionOptions& options)
{
  if (readings.frames == 0)
    return "no frame can be read";
  if (!tracked)
    return "no frame that has a pose can be read";
  std::ostringstream text;
  text.precision (3);
  if (readings.nearest_m > options.front_end.max_depth_m && std::isfinite (readings.nearest_m))
    text << "no reading is nearer than --max-depth " << options.front_end.max_depth_m << " m: the nearest is "
         << readings.nearest_m << " m away";
  else
    text << "the camera could not be tracked in any frame";
  return text.str ();
}

/** \brief Add the warnings of readers. \throws IoError if no frame could be used */
void
requireKeyframes (const FrameReadings& readings, std::size_t points, const std::vector<std::string>& frame_warnings,
                  const FrameContext& context, const FusionOptions& options, bool tracked, FusionResult& result)
{
  const std::vector<std::string> mask_warnings = context.masks ().warnings ();
  result.warnings.insert (result.warnings.end (), frame_warnings.begin (), frame_warnings.end ());
  result.warnings.insert (result.warnings.end (), mask_warnings.begin (), mask_warnings.end ());
  if (result.frames == 0)
    throw IoError (whyNoFrame (readings, tracked, options) + firstReason (frame_warnings));
  if (result.keyframes == 0 || context.masks ().lacksMasks ())
    throw IoError ("no frame has a mask that can be used" + firstReason (mask_warnings));
  if (points == 0)
  {
    std::ostringstream text;
    text << "no keyframe has a surface nearer than " << options.keyframe.max_depth_m << " m"
         << firstReason (frame_warnings);
    throw IoError (text.str ());
  }
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
  if (sequence_.masks) // what a mask misses would be background
    options_.backend.method.leave_out_moved = true;
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
  if (sequence.masks || (sequence.segmenter && sequence.segmenter->isExact ())) // what they find later was background
    options_.backend.method.leave_out_moved = true;
  options.validate ();
  requireFrames (*sequence.images, options_);
}

FusionResult
SequenceFusion::run (const ProgressCallback& progress, const KeyframeCallback& on_keyframe,
                     const FrameCallback& on_frame) const
{
  const RgbdSequence& images = tracked_ ? *tracked_->images : *sequence_.images;
  FusionRun run (images.camera (), options_,
                 tracked_ ? makeTrackedPoses (*tracked_, options_) : makeKnownPoses (sequence_, options_));
  FusionResult& result = run.result ();
  warnOfRange (images, options_.frames, result);
  RunProgress run_progress (progress, options_.frames, images.size ());
  const auto report = [&] { run_progress.reportKeyframe (); };
  FrameReader reader (images, options_.frames);
  FrameReadings readings;
  while (const auto frame = readFrame (reader, options_.ignored, result.timings_s["read"]))
  {
    run_progress.reportFrame (frame->index, run.context ());
    readings.add (frame->depth);
    if (run.add (*frame, on_frame))
      run.followUpdates (report, on_keyframe, false);
  }
  requireKeyframes (readings, run.points (), reader.warnings (), run.context (), options_, tracked_.has_value (),
                    result);
  result.frames_left_out = std::min (options_.frames.last, images.size ()) - options_.frames.first - result.frames;
  run.followUpdates (report, on_keyframe, true);
  return run.complete ([&] (const std::string& stage, double fraction) {
    run_progress.report (stage, frames_share + (1.0 - frames_share) * fraction);
    return true;
  });
}

/** \brief What a stream of frames has: its options outlive what refers to them. */
struct OnlineFusion::Impl
{
  Impl (const PinholeCamera& of_images, const FusionOptions& given, std::shared_ptr<FrameSegmenter> segmenter)
      : camera (of_images)
      , options (given)
      , run (of_images, options,
             makeTrackedPoses ({of_images, [this] (const RgbdFrame&) { return std::exchange (mask, std::nullopt); },
                                std::move (segmenter), given.front_end.objects},
                               options))
  {}

  const PinholeCamera camera;
  const FusionOptions options;
  std::optional<Image<std::uint16_t>> mask; ///< of the next frame
  std::size_t frames = 0;
  double stamp = 0.0; ///< of the last frame
  bool is_busy = false;
  FusionRun run;
};

namespace {

/** \brief While a member function runs, callbacks of it must not call another. */
class Busy
{
public:
  explicit Busy (bool& is_busy) : is_busy_ (is_busy)
  {
    if (is_busy)
      throw InvalidArgument ("add () and complete () must not be called from a callback of them");
    is_busy = true;
  }

  ~Busy () { is_busy_ = false; }

  Busy (const Busy&) = delete;
  Busy& operator= (const Busy&) = delete;

private:
  bool& is_busy_;
};

} // namespace

OnlineFusion::OnlineFusion (const PinholeCamera& camera, const FusionOptions& options,
                            std::shared_ptr<FrameSegmenter> segmenter)
{
  FusionOptions own = options;
  if (!segmenter || segmenter->isExact ())
    own.backend.method.leave_out_moved = true;
  own.updates = KeyframeUpdates::None;
  own.validate ();
  camera.validate ();
  impl_ = std::make_unique<Impl> (camera, own, std::move (segmenter));
}

OnlineFusion::~OnlineFusion () = default;
OnlineFusion::OnlineFusion (OnlineFusion&&) noexcept = default;
OnlineFusion& OnlineFusion::operator= (OnlineFusion&&) noexcept = default;

bool
OnlineFusion::add (RgbdFrame frame, const Image<std::uint16_t>* mask, const SequenceFusion::FrameCallback& on_frame)
{
  const Busy busy (impl_->is_busy);
  requireSizeOf (impl_->camera, frame.depth, "the depth image");
  if (!frame.colour.pixels.empty ())
    requireSizeOf (impl_->camera, frame.colour, "the colour image");
  if (mask)
    requireSizeOf (impl_->camera, *mask, "the mask");
  if (!std::isfinite (frame.stamp) || (impl_->frames > 0 && frame.stamp <= impl_->stamp))
    throw InvalidArgument ("the stamp of a frame must be finite, and larger than that of the frame before");
  impl_->stamp = frame.stamp;
  frame.index = impl_->frames++;
  if (mask)
    impl_->mask = *mask;
  leaveOut (impl_->options.ignored, frame);
  return impl_->run.add (frame, on_frame);
}

FusionResult
OnlineFusion::complete (const ProgressCallback& progress)
{
  const Busy busy (impl_->is_busy);
  if (impl_->run.result ().frames == 0)
    throw DegenerateInput (impl_->frames == 0 ? "there is no frame" : "the camera could not be tracked in any frame");
  if (impl_->run.points () == 0)
  {
    std::ostringstream text;
    text << "no keyframe has a surface nearer than " << impl_->options.keyframe.max_depth_m << " m";
    throw DegenerateInput (text.str ());
  }
  impl_->run.result ().frames_left_out = impl_->frames - impl_->run.result ().frames;
  return impl_->run.complete (progress);
}

} // namespace pcl::cosection
