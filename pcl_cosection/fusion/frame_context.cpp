// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_context.h"

#include "pcl_cosection/fusion/mapping/object_tsdf.h"
#include "pcl_cosection/sequence/median_depth.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

/** \brief The masks of files; no source without files. */
MaskSource
sourceOf (const MaskSequence* masks)
{
  if (!masks)
    return {};
  return [masks] (const RgbdFrame& frame) { return masks->read (frame.stamp); };
}

using PosesByFrame = std::vector<std::optional<Eigen::Isometry3d>>;

/** \brief An object of the masks, of a trajectory or of both. */
struct KnownObject
{
  explicit KnownObject (const ObjectTsdfOptions& options) : tsdf (options) {}

  /** \brief Its pose in a frame, if that is known. */
  std::optional<Eigen::Isometry3d> pose (std::size_t frame) const
  {
    if (!T_world_object.empty ())
      return T_world_object[frame];
    return seen ? std::optional<Eigen::Isometry3d> (Eigen::Isometry3d::Identity ()) : std::nullopt;
  }

  PosesByFrame T_world_object; ///< empty: it has no trajectory, and is at rest
  bool seen = false;           ///< in a keyframe
  ObjectTsdf tsdf;
};

/** \brief Poses and masks are given; TSDF volumes are made of the masked pixels. */
class KnownPoses : public FrameContext
{
public:
  KnownPoses (const KnownSequence& sequence, const FusionOptions& options)
      : FrameContext ({sourceOf (sequence.masks), sequence.images->camera ()})
      , sequence_ (sequence)
      , options_ (options)
  {
    const std::vector<double> stamps = sequence.images->stamps ();
    const double period = sequence.images->period ();
    T_world_camera_ = posesAtStamps (sequence.camera, stamps, period);
    for (const auto& [id, trajectory] : sequence.objects)
      objectOf (id).T_world_object = posesAtStamps (trajectory, stamps, period);
  }

  FrameKnowns next (const RgbdFrame& frame) override
  {
    FrameKnowns known;
    known.T_world_camera = T_world_camera_[frame.index];
    known.masked = true;
    ++frames_;
    frames_without_pose_ += !known.T_world_camera;
    if (known.T_world_camera)
      noteStep (frame.depth, known.T_world_camera->translation ());
    const ScopedSeconds timer (segmentation_s_);
    if (known.T_world_camera)
      known.instances = sequence_.masks ? masks_.read (frame) : Image<std::uint16_t> ();
    return known;
  }

  CoSectionBackend::Poses mapObjects (const RgbdFrame& frame, const FrameKnowns& known, Keyframe* keyframe) override
  {
    if (keyframe)
    {
      keyframe->points.erase (ignored_label);
      placeVolumes (*keyframe, frame.index);
    }
    CoSectionBackend::Poses poses;
    for (const auto& [id, object] : objects_)
      if (const auto T_world_object = object.pose (frame.index))
        poses[id] = *T_world_object;
    if (!known.instances || known.instances->pixels.empty ())
      return poses;
    const ScopedSeconds timer (integration_s_);
    TsdfPixels pixels;
    pixels.labels = &*known.instances;
    if (!frame.colour.pixels.empty ())
      pixels.colours = &frame.colour;
    for (const auto& [id, T_world_object] : poses)
    {
      pixels.label = static_cast<std::uint16_t> (id);
      objects_.at (id).tsdf.integrate (frame.depth, sequence_.images->camera (),
                                       T_world_object.inverse () * *known.T_world_camera, pixels);
    }
    return poses;
  }

  TriangleMesh surfaceMesh (int id) const override
  {
    const auto object = objects_.find (id);
    return object == objects_.end () || !object->second.tsdf.volume () ? TriangleMesh ()
                                                                       : object->second.tsdf.volume ()->surfaceMesh ();
  }

  std::string whyNoObject () const override
  {
    const std::string empty = masks_.emptiness ();
    return "the masks show no object: " +
           (empty.empty () ? "no keyframe has enough readings where they have one" : empty);
  }

  void finish (FusionResult& result) override
  {
    result.timings_s["segmentation"] += segmentation_s_;
    result.timings_s["integration"] += integration_s_;
    for (const auto& [id, object] : objects_)
    {
      if (object.tsdf.volume ())
        result.objects[id].tsdf = object.tsdf.volume ()->surfaceMesh ();
      if (object.T_world_object.empty ())
        result.warnings.push_back ("object " + std::to_string (id) +
                                   " of the masks has no trajectory: it is taken to be at rest");
    }
    if (frames_without_pose_ > 0)
      result.warnings.push_back (std::to_string (frames_without_pose_) + " of " + std::to_string (frames_) +
                                 " frames were left out: the camera's trajectory has no pose for them");
    if (2 * far_steps_ > frames_)
      result.warnings.push_back ("between most frames the camera moves farther than what it sees is away: its poses "
                                 "must be in metres, as the depth");
    for (const auto& [id, trajectory] : sequence_.objects)
      if (result.objects[id].points == 0)
        result.warnings.push_back ("object " + std::to_string (id) +
                                   " has a trajectory, but no points in any keyframe");
  }

private:
  KnownObject& objectOf (int id) { return objects_.try_emplace (id, options_.tsdf).first->second; }

  /** \brief Note whether the camera moved farther than the middle of what it sees is away. */
  void noteStep (const Image<float>& depth, const Eigen::Vector3d& place)
  {
    const std::optional<float> middle = medianDepth (depth);
    if (last_place_ && middle && (place - *last_place_).norm () > *middle)
      ++far_steps_;
    last_place_ = place;
  }

  /** \brief Make room for the points of a keyframe. */
  void placeVolumes (const Keyframe& keyframe, std::size_t frame)
  {
    for (const auto& [id, points] : keyframe.points)
    {
      if (id != 0)
        objectOf (id).seen = true;
      const auto object = objects_.find (id);
      const auto T_world_object = object == objects_.end () ? std::nullopt : object->second.pose (frame);
      if (!T_world_object)
        continue;
      std::vector<OrientedPoint> local (points);
      const Eigen::Isometry3d T_object_camera = T_world_object->inverse () * keyframe.view.T_world_sensor;
      for (OrientedPoint& point : local)
        point.position = (T_object_camera * point.position.cast<double> ()).cast<float> ();
      object->second.tsdf.makeRoom (local);
    }
  }

  const KnownSequence& sequence_;
  const FusionOptions& options_;
  PosesByFrame T_world_camera_;
  std::map<int, KnownObject> objects_;
  std::size_t frames_ = 0;
  std::size_t frames_without_pose_ = 0;
  std::size_t far_steps_ = 0;
  std::optional<Eigen::Vector3d> last_place_; // of the camera
  double segmentation_s_ = 0.0;
  double integration_s_ = 0.0;
};

DynamicFusionOptions
frontEndOptions (DynamicFusionOptions options, bool has_objects)
{
  options.objects = has_objects;
  return options;
}

/** \brief Poses and instances are found by DynamicFusion. */
class TrackedPoses : public FrameContext
{
public:
  TrackedPoses (const TrackedFrames& frames, const FusionOptions& options)
      : FrameContext ({frames.masks, frames.camera})
      , has_objects_ (frames.has_objects)
      , max_object_depth_m_ (options.front_end.max_object_depth_m)
      , fusion_ (frames.camera, frontEndOptions (options.front_end, has_objects_))
  {
    fusion_.setSegmenter (frames.segmenter);
  }

  FrameKnowns next (const RgbdFrame& frame) override
  {
    std::optional<Image<std::uint16_t>> mask;
    {
      const ScopedSeconds timer (masks_s_);
      mask = masks_.read (frame);
    }
    if (frames_ == 0)
      first_depth_m_ = medianDepth (frame.depth);
    tracked_ = &fusion_.process (frame, mask ? &*mask : nullptr);
    ++frames_;
    frames_lost_ += !tracked_->T_world_camera;
    frames_of_objects_ += tracked_->only_objects;
    for (const auto& [id, T] : tracked_->T_world_object)
      tracked_ids_.insert (id);
    FrameKnowns known;
    known.T_world_camera = tracked_->T_world_camera;
    known.masked = !has_objects_ || tracked_->masked;
    if (known.T_world_camera)
      known.instances = tracked_->instances;
    return known;
  }

  CoSectionBackend::Poses mapObjects (const RgbdFrame&, const FrameKnowns&, Keyframe* keyframe) override
  {
    if (keyframe)
      keyframe->points.erase (TrackedFrame::unassigned);
    return tracked_->T_world_object;
  }

  std::set<int> wrongObjects () const override
  {
    const std::set<int> found = fusion_.foundObjects ();
    std::set<int> wrong;
    std::set_difference (tracked_ids_.begin (), tracked_ids_.end (), found.begin (), found.end (),
                         std::inserter (wrong, wrong.end ()));
    return wrong;
  }

  TriangleMesh surfaceMesh (int id) const override { return fusion_.surfaceMesh (id); }

  std::string status () const override
  {
    if (!tracked_)
      return "";
    std::string text;
    if (has_objects_)
      text = std::to_string (fusion_.objects ().size ()) + " objects, ";
    if (tracked_->lost > 0)
      text += std::to_string (tracked_->lost) + " lost, ";
    if (!tracked_->T_world_camera)
      return text + "camera lost";
    return text + "fit " + std::to_string (std::lround (100.0 * tracked_->inlier_share)) + " %";
  }

  std::string whyNoObject () const override
  {
    const std::string shown = "the masks show no object that could be tracked: ";
    if (const std::string empty = masks_.emptiness (); !empty.empty ())
      return shown + empty;
    if (!tracked_ids_.empty ())
      return shown + "all were given up";
    const std::string refused = refusedInstances ();
    return shown + (refused.empty () ? "where they have one, no frame has depth" : refused) + oddDepth ();
  }

  void finish (FusionResult& result) override
  {
    for (const auto& [stage, seconds] : fusion_.timings ())
      result.timings_s[stage] += seconds;
    result.timings_s["segmentation"] += masks_s_;
    result.tracked = true;
    result.events = fusion_.events ();
    if (frames_lost_ > 0)
      result.warnings.push_back (std::to_string (frames_lost_) + " of " + std::to_string (frames_) +
                                 " frames were left out: the camera could not be tracked in them");
    if (frames_of_objects_ > 0)
      result.warnings.push_back ("in " + std::to_string (frames_of_objects_) + " of " + std::to_string (frames_) +
                                 " frames only objects have readings: the camera was taken to be at rest in them");
    const std::set<int> found = fusion_.foundObjects ();
    for (auto object = result.objects.begin (); object != result.objects.end ();)
    {
      const int id = object->first;
      if (found.count (id) == 0)
      {
        object = eraseObject (object, true, result);
        continue;
      }
      if (object->second.points == 0)
        result.warnings.push_back ("object " + std::to_string (id) + " was left out: no keyframe shows it");
      object->second.tsdf = fusion_.surfaceMesh (id);
      object->second.best_class = fusion_.objectClass (id);
      ++object;
    }
    if (!tracked_ids_.empty () || !masks_.hasMasks ())
      if (const std::string refused = refusedInstances (); !refused.empty ())
        result.warnings.push_back (refused);
  }

private:
  /** \brief A line about instances of masks that are no object; empty if all are, or there are none. */
  std::string refusedInstances () const
  {
    const auto refused = fusion_.refusedInstances ();
    if (refused.empty ())
      return {};
    return "instance " + std::to_string (refused.begin ()->first) +
           " of the masks is no object: " + refused.begin ()->second +
           (refused.size () > 1 ? "; likewise " + std::to_string (refused.size () - 1) + " more" : "");
  }

  /** \brief What the first frame's depths say of their scale; empty if objects may be that far away. */
  std::string oddDepth () const
  {
    if (!first_depth_m_ || *first_depth_m_ <= max_object_depth_m_)
      return {};
    std::ostringstream text;
    text.precision (3);
    text << "; half of the depths of the first frame are more than " << *first_depth_m_
         << " m: give --depth-scale if their unit is another";
    return text.str ();
  }

  const bool has_objects_;
  const double max_object_depth_m_;
  DynamicFusion fusion_;
  const TrackedFrame* tracked_ = nullptr; // of the last frame
  std::set<int> tracked_ids_;             // of objects in any frame
  std::size_t frames_ = 0;
  std::size_t frames_lost_ = 0;
  std::size_t frames_of_objects_ = 0;
  std::optional<float> first_depth_m_; // the median of the first frame
  double masks_s_ = 0.0;
};

} // namespace

std::unique_ptr<FrameContext>
makeKnownPoses (const KnownSequence& sequence, const FusionOptions& options)
{
  return std::make_unique<KnownPoses> (sequence, options);
}

std::unique_ptr<FrameContext>
makeTrackedPoses (const TrackedSequence& sequence, const FusionOptions& options)
{
  return makeTrackedPoses (
      {sequence.images->camera (), sourceOf (sequence.masks), sequence.segmenter, sequence.masks || sequence.segmenter},
      options);
}

std::unique_ptr<FrameContext>
makeTrackedPoses (const TrackedFrames& frames, const FusionOptions& options)
{
  return std::make_unique<TrackedPoses> (frames, options);
}

std::map<int, FusedObject>::iterator
eraseObject (std::map<int, FusedObject>::iterator object, bool completed, FusionResult& result)
{
  std::vector<ObjectResult>& completions = result.scene.objects;
  completions.erase (std::remove_if (completions.begin (), completions.end (),
                                     [&] (const ObjectResult& completion) {
                                       return completion.id == object->first &&
                                              (completed || !completion.error.empty ());
                                     }),
                     completions.end ());
  return result.objects.erase (object);
}

} // namespace pcl::cosection
