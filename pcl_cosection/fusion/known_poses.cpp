// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_context.h"

#include "pcl_cosection/fusion/mapping/object_tsdf.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <algorithm>
#include <map>

namespace pcl::cosection {
namespace {

using PosesByFrame = std::vector<std::optional<Eigen::Isometry3d>>;

/** \brief An object of the masks, of a trajectory or of both. */
struct KnownObject
{
  PosesByFrame T_world_object; ///< empty: it has no trajectory, and is at rest
  bool seen = false;           ///< in a keyframe
  std::optional<ObjectTsdf> tsdf;

  /** \brief Its pose in a frame, if that is known. */
  std::optional<Eigen::Isometry3d> pose (std::size_t frame) const
  {
    if (!T_world_object.empty ())
      return T_world_object[frame];
    return seen ? std::optional<Eigen::Isometry3d> (Eigen::Isometry3d::Identity ()) : std::nullopt;
  }
};

/** \brief Poses and masks are given; TSDF volumes are made of the masked pixels. */
class KnownPoses : public FrameContext
{
public:
  KnownPoses (const KnownSequence& sequence, const FusionOptions& options);

  FrameKnowns next (const RgbdFrame& frame) override;

  CoSectionBackend::Poses mapObjects (const RgbdFrame& frame, const FrameKnowns& known, Keyframe* keyframe) override;

  TriangleMesh surfaceMesh (int id) const override
  {
    const auto object = objects_.find (id);
    return object == objects_.end () || !object->second.tsdf || !object->second.tsdf->volume ()
               ? TriangleMesh ()
               : object->second.tsdf->volume ()->surfaceMesh ();
  }

  std::vector<std::string> maskWarnings () const override { return masks_.warnings (); }

  void finish (FusionResult& result) override;

private:
  /** \brief Make room for the points of a keyframe. */
  void placeVolumes (const Keyframe& keyframe, std::size_t frame);

  const KnownSequence& sequence_;
  const FusionOptions& options_;
  MaskReader masks_;
  PosesByFrame T_world_camera_;
  std::map<int, KnownObject> objects_;
  std::size_t frames_ = 0;
  std::size_t frames_without_pose_ = 0;
  double segmentation_s_ = 0.0;
  double integration_s_ = 0.0;
};

KnownPoses::KnownPoses (const KnownSequence& sequence, const FusionOptions& options)
    : sequence_ (sequence)
    , options_ (options)
    , masks_ (sequence.masks)
{
  const std::vector<double> stamps = sequence.images->stamps ();
  const double period = sequence.images->period ();
  T_world_camera_ = posesAtStamps (sequence.camera, stamps, period);
  for (const auto& [id, trajectory] : sequence.objects)
    objects_[id].T_world_object = posesAtStamps (trajectory, stamps, period);
}

FrameKnowns
KnownPoses::next (const RgbdFrame& frame)
{
  FrameKnowns known;
  known.T_world_camera = T_world_camera_[frame.index];
  known.masked = true;
  ++frames_;
  frames_without_pose_ += !known.T_world_camera;
  const ScopedSeconds timer (segmentation_s_);
  if (known.T_world_camera)
    known.instances = sequence_.masks ? masks_.read (frame) : Image<std::uint16_t> ();
  return known;
}

void
KnownPoses::placeVolumes (const Keyframe& keyframe, std::size_t frame)
{
  for (const auto& [id, points] : keyframe.points)
    if (id != 0)
      objects_[id].seen = true;
  for (const auto& [id, points] : keyframe.points)
  {
    const auto object = objects_.find (id);
    const auto T_world_object = object == objects_.end () ? std::nullopt : object->second.pose (frame);
    if (!T_world_object)
      continue;
    std::vector<OrientedPoint> local (points);
    const Eigen::Isometry3d T_object_camera = T_world_object->inverse () * keyframe.view.T_world_sensor;
    for (OrientedPoint& point : local)
      point.position = (T_object_camera * point.position.cast<double> ()).cast<float> ();
    if (!object->second.tsdf)
      object->second.tsdf.emplace (options_.tsdf);
    object->second.tsdf->makeRoom (local);
  }
}

CoSectionBackend::Poses
KnownPoses::mapObjects (const RgbdFrame& frame, const FrameKnowns& known, Keyframe* keyframe)
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
  for (const auto& [id, T_world_object] : poses)
  {
    std::optional<ObjectTsdf>& tsdf = objects_.at (id).tsdf;
    if (!tsdf)
      continue;
    TsdfPixels pixels;
    pixels.labels = &*known.instances;
    pixels.label = static_cast<std::uint16_t> (id);
    if (!frame.colour.pixels.empty ())
      pixels.colours = &frame.colour;
    tsdf->integrate (frame.depth, sequence_.images->camera (), T_world_object.inverse () * *known.T_world_camera,
                     pixels);
  }
  return poses;
}

void
KnownPoses::finish (FusionResult& result)
{
  result.timings_s["segmentation"] += segmentation_s_;
  result.timings_s["integration"] += integration_s_;
  for (const auto& [id, object] : objects_)
  {
    if (object.tsdf && object.tsdf->volume ())
      result.objects[id].tsdf = object.tsdf->volume ()->surfaceMesh ();
    if (object.T_world_object.empty ())
      result.warnings.push_back ("object " + std::to_string (id) +
                                 " of the masks has no trajectory: it is taken to be at rest");
  }
  if (frames_without_pose_ > 0)
    result.warnings.push_back (std::to_string (frames_without_pose_) + " of " + std::to_string (frames_) +
                               " frames were left out: the camera's trajectory has no pose for them");
  const bool saw_object = std::any_of (objects_.begin (), objects_.end (),
                                       [] (const auto& object) { return object.second.seen; });
  if (sequence_.masks && result.objects.empty () && !saw_object)
    result.warnings.push_back ("the masks show no object in any keyframe");
  for (const auto& [id, trajectory] : sequence_.objects)
    if (result.objects[id].points == 0)
      result.warnings.push_back ("object " + std::to_string (id) + " has a trajectory, but no points in any keyframe");
}

} // namespace

std::unique_ptr<FrameContext>
makeKnownPoses (const KnownSequence& sequence, const FusionOptions& options)
{
  return std::make_unique<KnownPoses> (sequence, options);
}

} // namespace pcl::cosection
