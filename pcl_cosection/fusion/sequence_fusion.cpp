// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/fusion/sequence_fusion.h>

#include "frame_check.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/stamp_matching.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double frames_share = 0.5; // of the progress; the rest is the last solution
constexpr std::size_t min_object_points = 100;
constexpr std::size_t most_mask_warnings = 20;

/** \brief One execution of SequenceFusion::run (). */
class FusionRun
{
public:
  FusionRun (const KnownSequence& sequence, const FusionOptions& options, const ProgressCallback& progress,
             const SequenceFusion::KeyframeCallback& report);

  FusionResult
  run ();

private:
  void
  report (const std::string& stage, double fraction) const;
  void
  use (const RgbdFrame& frame);
  std::optional<Image<std::uint16_t>>
  mask (const RgbdFrame& frame);
  /** \brief Of the objects that are known at a frame; those in the mask without a trajectory are at rest. */
  CoSectionBackend::Poses
  poses (std::size_t frame) const;
  void
  findNewObjects (const Keyframe& keyframe);
  void
  addKeyframe (const RgbdFrame& frame, const Image<std::uint16_t>& mask, const Eigen::Isometry3d& T_world_camera);
  void
  integrate (const RgbdFrame& frame, const Image<std::uint16_t>& mask, const Eigen::Isometry3d& T_world_camera,
             const CoSectionBackend::Poses& T_world_object);
  void
  finish ();
  void
  warnOfPoses ();
  /** \brief Those with too few points, which are no failure: masks have stray pixels. */
  void
  leaveOutSmallObjects ();
  template <typename Function> void
  timed (const char* stage, Function&& f);

  const KnownSequence& sequence_;
  const FusionOptions& options_;
  const ProgressCallback& progress_;
  const SequenceFusion::KeyframeCallback& report_;
  FusionResult result_;
  CoSectionBackend backend_;
  std::vector<std::optional<Eigen::Isometry3d>> camera_; // by frame
  std::map<int, std::vector<std::optional<Eigen::Isometry3d>>> objects_;
  std::set<int> at_rest_;
  std::map<int, ObjectTsdf> tsdf_;
  std::size_t frames_of_range_ = 0;
  std::size_t without_pose_ = 0;
  std::size_t points_without_pose_ = 0;
  std::size_t points_ = 0; // in all keyframes
  std::vector<std::string> mask_warnings_;
  std::size_t more_mask_warnings_ = 0;
  std::optional<std::size_t> next_keyframe_;
};

FusionRun::FusionRun (const KnownSequence& sequence, const FusionOptions& options, const ProgressCallback& progress,
                      const SequenceFusion::KeyframeCallback& report)
: sequence_ (sequence), options_ (options), progress_ (progress), report_ (report), backend_ (options.backend)
{
  const std::vector<double> stamps = sequence.images->stamps ();
  const double period = sequence.images->period ();
  camera_ = posesAtStamps (sequence.camera, stamps, period);
  for (const auto& [id, trajectory] : sequence.objects)
    objects_[id] = posesAtStamps (trajectory, stamps, period);
  frames_of_range_ = std::min (options.frames.last, stamps.size ()) - std::min (options.frames.first, stamps.size ());
}

void
FusionRun::report (const std::string& stage, double fraction) const
{
  if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
    throw Cancelled ("cancelled");
}

template <typename Function> void
FusionRun::timed (const char* stage, Function&& f)
{
  const auto start = std::chrono::steady_clock::now ();
  f ();
  result_.timings_s[stage] += std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
}

std::optional<Image<std::uint16_t>>
FusionRun::mask (const RgbdFrame& frame)
{
  if (!sequence_.masks)
    return Image<std::uint16_t> ();
  try
  {
    return sequence_.masks->read (frame.stamp);
  }
  catch (const Error& error)
  {
    if (mask_warnings_.size () < most_mask_warnings)
      mask_warnings_.push_back (std::string (error.what ()) + "; the frame is used without it");
    else
      ++more_mask_warnings_;
    return std::nullopt;
  }
}

CoSectionBackend::Poses
FusionRun::poses (std::size_t frame) const
{
  CoSectionBackend::Poses poses;
  for (const int id : at_rest_)
    poses[id] = Eigen::Isometry3d::Identity ();
  for (const auto& [id, at_frames] : objects_)
    if (at_frames[frame])
      poses[id] = *at_frames[frame];
  return poses;
}

void
FusionRun::findNewObjects (const Keyframe& keyframe)
{
  for (const auto& [id, points] : keyframe.points)
    if (id != 0 && objects_.count (id) == 0 && at_rest_.insert (id).second)
      result_.warnings.push_back ("object " + std::to_string (id) +
                                  " of the masks has no trajectory: it is taken to be at rest");
}

void
FusionRun::addKeyframe (const RgbdFrame& frame, const Image<std::uint16_t>& mask, const Eigen::Isometry3d& T_world_camera)
{
  const Keyframe keyframe = makeKeyframe (frame, sequence_.images->camera (), mask, T_world_camera, options_.keyframe);
  findNewObjects (keyframe);
  const CoSectionBackend::Poses T_world_object = poses (frame.index);
  for (const auto& [id, points] : keyframe.points)
  {
    points_ += points.size ();
    if (id == 0)
      continue;
    const auto pose = T_world_object.find (id);
    if (pose == T_world_object.end ())
    {
      points_without_pose_ += points.size ();
      continue;
    }
    result_.objects[id].points += points.size ();
    std::vector<OrientedPoint> local (points);
    const Eigen::Isometry3d T_object_camera = pose->second.inverse () * T_world_camera;
    for (OrientedPoint& point : local)
      point.position = (T_object_camera * point.position.cast<double> ()).cast<float> ();
    tsdf_.try_emplace (id, options_.tsdf).first->second.makeRoom (local);
  }
  backend_.addKeyframe (keyframe, T_world_object);
  ++result_.keyframes;
}

void
FusionRun::integrate (const RgbdFrame& frame, const Image<std::uint16_t>& mask, const Eigen::Isometry3d& T_world_camera,
                      const CoSectionBackend::Poses& T_world_object)
{
  for (auto& [id, tsdf] : tsdf_)
  {
    const auto pose = T_world_object.find (id);
    if (pose == T_world_object.end ())
      continue;
    TsdfPixels pixels;
    pixels.labels = &mask;
    pixels.label = static_cast<std::uint16_t> (id);
    if (!frame.colour.pixels.empty ())
      pixels.colours = &frame.colour;
    tsdf.integrate (frame.depth, sequence_.images->camera (), pose->second.inverse () * T_world_camera, pixels);
  }
}

void
FusionRun::use (const RgbdFrame& frame)
{
  const std::optional<Eigen::Isometry3d>& T_world_camera = camera_[frame.index];
  if (!T_world_camera)
  {
    ++without_pose_;
    return;
  }
  ++result_.frames;
  result_.camera.push_back ({frame.stamp, *T_world_camera});
  if (!next_keyframe_)
    next_keyframe_ = frame.index;
  std::optional<Image<std::uint16_t>> instances;
  timed ("segmentation", [&] { instances = mask (frame); });

  const bool is_keyframe = instances && frame.index >= *next_keyframe_;
  if (is_keyframe)
  {
    timed ("keyframes", [&] { addKeyframe (frame, *instances, *T_world_camera); });
    while (*next_keyframe_ <= frame.index)
      *next_keyframe_ += static_cast<std::size_t> (options_.keyframe_every);
  }
  const CoSectionBackend::Poses T_world_object = poses (frame.index);
  for (const auto& [id, T] : T_world_object)
    result_.objects[id].trajectory.push_back ({frame.stamp, T});
  if (!is_keyframe)
    timed ("keyframes", [&] {
      backend_.addFrame (makeDepthView (frame.depth, sequence_.images->camera (), *T_world_camera, options_.keyframe),
                         T_world_object);
    });
  if (instances && !instances->pixels.empty ())
    timed ("integration", [&] { integrate (frame, *instances, *T_world_camera, T_world_object); });
  if (is_keyframe && options_.update_at_keyframes)
    timed ("updates", [&] {
      const double done = frames_share * static_cast<double> (frame.index - options_.frames.first) /
                          static_cast<double> (frames_of_range_);
      const SceneResult scene = backend_.update (UpdateOutput::Meshes, [&] (const std::string&, double) {
        report ("keyframe", done);
        return true;
      });
      if (report_)
        report_ ({frame.stamp, scene});
    });
}

void
FusionRun::finish ()
{
  timed ("final_solve", [&] {
    result_.scene = backend_.solve ([&] (const std::string& stage, double fraction) {
      report (stage, frames_share + (1.0 - frames_share) * fraction);
      return true;
    });
  });
  for (const auto& [stage, seconds] : result_.scene.timings_s)
    result_.timings_s[stage] += seconds;
  for (auto& [id, tsdf] : tsdf_)
    if (tsdf.volume ())
      result_.objects[id].tsdf = tsdf.volume ()->surfaceMesh ();
  result_.kept_keyframes = backend_.keyframes ();
  warnOfPoses ();
  leaveOutSmallObjects ();
  result_.warnings.insert (result_.warnings.end (), result_.scene.warnings.begin (), result_.scene.warnings.end ());
}

void
FusionRun::warnOfPoses ()
{
  if (without_pose_ > 0)
    result_.warnings.push_back (std::to_string (without_pose_) + " of " + std::to_string (without_pose_ + result_.frames) +
                                " frames were left out: the camera's trajectory has no pose for them");
  if (points_without_pose_ > 0)
    result_.warnings.push_back (std::to_string (points_without_pose_) +
                                " points of objects were left out: their trajectories have no pose for those frames");
  if (sequence_.masks && result_.objects.empty () && points_without_pose_ == 0)
    result_.warnings.push_back ("the masks show no object in any keyframe");
}

void
FusionRun::leaveOutSmallObjects ()
{
  for (const auto& [id, trajectory] : sequence_.objects)
    if (result_.objects[id].points == 0)
      result_.warnings.push_back ("object " + std::to_string (id) + " has a trajectory, but no points in any keyframe");
  for (auto object = result_.objects.begin (); object != result_.objects.end ();)
  {
    const auto& [id, fused] = *object;
    if (fused.points >= min_object_points)
    {
      ++object;
      continue;
    }
    if (fused.points > 0)
      result_.warnings.push_back ("object " + std::to_string (id) + " was left out: it has only " + std::to_string (fused.points) +
                                  " points in all keyframes; " + std::to_string (min_object_points) + " are needed");
    auto& completed = result_.scene.objects;
    completed.erase (std::remove_if (completed.begin (), completed.end (),
                                     [id = id] (const ObjectResult& result) { return result.id == id && !result.error.empty (); }),
                     completed.end ());
    object = result_.objects.erase (object);
  }
}

FusionResult
FusionRun::run ()
{
  if (options_.frames.last > sequence_.images->size () && options_.frames.last != FrameRange ().last)
    result_.warnings.push_back ("frames from " + std::to_string (sequence_.images->size ()) + " on are not there; the sequence has 0:" +
                                std::to_string (sequence_.images->size ()));
  FrameReader reader (*sequence_.images, options_.frames);
  std::size_t read = 0;
  while (true)
  {
    std::optional<RgbdFrame> frame;
    timed ("read", [&] { frame = reader.next (); });
    if (!frame)
      break;
    report ("frames", frames_share * static_cast<double> (frame->index - options_.frames.first) /
                          static_cast<double> (std::max<std::size_t> (1, frames_of_range_)));
    use (*frame);
    ++read;
  }
  if (more_mask_warnings_ > 0)
    mask_warnings_.push_back ("and " + std::to_string (more_mask_warnings_) + " more warnings about masks");
  const std::vector<std::string> warnings = reader.warnings ();
  const auto firstOf = [] (const std::vector<std::string>& lines) { return lines.empty () ? std::string () : ": " + lines.front (); };
  result_.warnings.insert (result_.warnings.end (), warnings.begin (), warnings.end ());
  result_.warnings.insert (result_.warnings.end (), mask_warnings_.begin (), mask_warnings_.end ());
  if (result_.frames == 0)
    throw IoError ((read == 0 ? "no frame can be read" : "no frame that has a pose can be read") + firstOf (warnings));
  if (result_.keyframes == 0)
    throw IoError ("no frame has a mask that can be used" + firstOf (mask_warnings_));
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
  if (keyframe_every < 1)
    throw InvalidArgument ("keyframe_every must be at least 1");
}

SequenceFusion::SequenceFusion (KnownSequence sequence, const FusionOptions& options)
: sequence_ (std::move (sequence)), options_ (options)
{
  options.validate ();
  if (!sequence_.images)
    throw InvalidArgument ("there are no images");
  if (sequence_.camera.empty ())
    throw InvalidArgument ("there is no pose of the camera");
  requireFrames (sequence_, options_.frames);
}

FusionResult
SequenceFusion::run (const ProgressCallback& progress, const KeyframeCallback& keyframe) const
{
  return FusionRun (sequence_, options_, progress, keyframe).run ();
}

} // namespace cosection
} // namespace pcl
