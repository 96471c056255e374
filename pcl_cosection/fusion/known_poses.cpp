// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "frame_context.h"

#include "pcl_cosection/fusion/mapping/object_tsdf.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/image.h>

#include <map>
#include <set>

namespace pcl::cosection
{

namespace
{

/** \brief Poses and masks are given; TSDF volumes are made of the masked pixels. */
class KnownPoses : public FrameContext
{
public:
  KnownPoses (const KnownSequence& sequence, const FusionOptions& options);

  std::optional<Eigen::Isometry3d> next (const RgbdFrame& frame) override;

  const std::optional<Image<std::uint16_t>>& instances () const override { return instances_; }

  bool isFitForKeyframe (std::size_t) const override { return instances_.has_value (); }

  void look (Keyframe& keyframe) override;

  /** \brief Those without a trajectory that were seen are at rest. */
  CoSectionBackend::Poses poses () const override;

  void map (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera) override;

  TriangleMesh seen (int id) const override
  {
    const auto found = tsdf_.find (id);
    return found == tsdf_.end () || !found->second.volume () ? TriangleMesh ()
                                                             : found->second.volume ()->surfaceMesh ();
  }

  std::string status () const override { return ""; }

  std::vector<std::string> maskWarnings () const override { return masks_.warnings (); }

  void finish (FusionResult& result) override;

private:
  const KnownSequence& sequence_;
  const FusionOptions& options_;
  MaskReader masks_;
  std::vector<std::optional<Eigen::Isometry3d>> camera_; // by frame
  std::map<int, std::vector<std::optional<Eigen::Isometry3d>>> objects_;
  std::set<int> at_rest_;
  std::map<int, ObjectTsdf> tsdf_;
  std::optional<Image<std::uint16_t>> instances_; // of the frame
  bool saw_object_ = false;
  std::size_t frame_ = 0;
  std::size_t frames_with_pose_ = 0;
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
  camera_ = posesAtStamps (sequence.camera, stamps, period);
  for (const auto& [id, trajectory] : sequence.objects)
    objects_[id] = posesAtStamps (trajectory, stamps, period);
}

std::optional<Eigen::Isometry3d>
KnownPoses::next (const RgbdFrame& frame)
{
  frame_ = frame.index;
  if (!camera_[frame_])
  {
    ++frames_without_pose_;
    return std::nullopt;
  }
  ++frames_with_pose_;
  addSeconds (segmentation_s_, [&] { instances_ = sequence_.masks ? masks_.read (frame) : Image<std::uint16_t> (); });
  return camera_[frame_];
}

void
KnownPoses::look (Keyframe& keyframe)
{
  keyframe.points.erase (ignored_label);
  for (const auto& [id, points] : keyframe.points)
  {
    saw_object_ = saw_object_ || id != 0;
    if (id != 0 && objects_.count (id) == 0)
      at_rest_.insert (id);
  }
  const CoSectionBackend::Poses T_world_object = poses ();
  for (const auto& [id, points] : keyframe.points)
  {
    const auto pose = T_world_object.find (id);
    if (pose == T_world_object.end ())
      continue;
    std::vector<OrientedPoint> local (points);
    const Eigen::Isometry3d T_object_camera = pose->second.inverse () * keyframe.view.T_world_sensor;
    for (OrientedPoint& point : local)
      point.position = (T_object_camera * point.position.cast<double> ()).cast<float> ();
    tsdf_.try_emplace (id, options_.tsdf).first->second.makeRoom (local);
  }
}

CoSectionBackend::Poses
KnownPoses::poses () const
{
  CoSectionBackend::Poses poses;
  for (const int id : at_rest_)
    poses[id] = Eigen::Isometry3d::Identity ();
  for (const auto& [id, at_frames] : objects_)
    if (at_frames[frame_])
      poses[id] = *at_frames[frame_];
  return poses;
}

void
KnownPoses::map (const RgbdFrame& frame, const Eigen::Isometry3d& T_world_camera)
{
  if (!instances_ || instances_->pixels.empty ())
    return;
  addSeconds (integration_s_, [&] {
    const CoSectionBackend::Poses T_world_object = poses ();
    for (auto& [id, tsdf] : tsdf_)
    {
      const auto pose = T_world_object.find (id);
      if (pose == T_world_object.end ())
        continue;
      TsdfPixels pixels;
      pixels.labels = &*instances_;
      pixels.label = static_cast<std::uint16_t> (id);
      if (!frame.colour.pixels.empty ())
        pixels.colours = &frame.colour;
      tsdf.integrate (frame.depth, sequence_.images->camera (), pose->second.inverse () * T_world_camera, pixels);
    }
  });
}

void
KnownPoses::finish (FusionResult& result)
{
  result.timings_s["segmentation"] += segmentation_s_;
  result.timings_s["integration"] += integration_s_;
  for (auto& [id, tsdf] : tsdf_)
    if (tsdf.volume ())
      result.objects[id].tsdf = tsdf.volume ()->surfaceMesh ();
  for (const int id : at_rest_)
    result.warnings.push_back ("object " + std::to_string (id) +
                               " of the masks has no trajectory: it is taken to be at rest");
  if (frames_without_pose_ > 0)
    result.warnings.push_back (std::to_string (frames_without_pose_) + " of " +
                               std::to_string (frames_without_pose_ + frames_with_pose_) +
                               " frames were left out: the camera's trajectory has no pose for them");
  if (sequence_.masks && result.objects.empty () && !saw_object_)
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
