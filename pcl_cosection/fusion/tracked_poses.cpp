// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "frame_context.h"

#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace pcl::cosection
{

namespace
{

bool
hasObjects (const TrackedSequence& sequence)
{
  return sequence.masks || sequence.segmenter;
}

DynamicFusionOptions
frontEndOptions (const TrackedSequence& sequence, const FusionOptions& options)
{
  DynamicFusionOptions front_end = options.front_end;
  front_end.objects = hasObjects (sequence);
  return front_end;
}

/** \brief Poses and what shows which object are found out frame by frame. */
class TrackedPoses : public FrameContext
{
public:
  TrackedPoses (const TrackedSequence& sequence, const FusionOptions& options)
      : options_ (options)
      , masks_ (sequence.masks)
      , with_masks_ (hasObjects (sequence))
      , fusion_ (sequence.images->camera (), frontEndOptions (sequence, options))
  {
    fusion_.setSegmenter (sequence.segmenter);
  }

  std::optional<Eigen::Isometry3d> next (const RgbdFrame& frame) override;

  const std::optional<Image<std::uint16_t>>& instances () const override { return instances_; }

  /** \brief A mask is waited for as long as one may still come. */
  bool isFitForKeyframe (std::size_t overdue) const override
  {
    return instances_ &&
           (!with_masks_ || tracked_->masked || overdue >= static_cast<std::size_t> (options_.keyframe_every));
  }

  void look (Keyframe& keyframe) override { keyframe.points.erase (TrackedFrame::unassigned); }

  CoSectionBackend::Poses poses () const override { return tracked_->T_world_object; }

  std::set<int> wrongObjects () const override
  {
    const std::set<int> found = fusion_.foundObjects ();
    std::set<int> wrong;
    std::set_difference (told_.begin (), told_.end (), found.begin (), found.end (),
                         std::inserter (wrong, wrong.end ()));
    return wrong;
  }

  void map (const RgbdFrame&, const Eigen::Isometry3d&) override {}

  TriangleMesh seen (int id) const override { return fusion_.surfaceMesh (id); }

  std::string status () const override;

  std::vector<std::string> maskWarnings () const override { return masks_.warnings (); }

  void finish (FusionResult& result) override;

private:
  const FusionOptions& options_;
  MaskReader masks_;
  const bool with_masks_;
  DynamicFusion fusion_;
  const TrackedFrame* tracked_ = nullptr; // of the frame
  std::optional<Image<std::uint16_t>> instances_;
  std::set<int> told_; // numbers of objects
  std::size_t frames_ = 0;
  std::size_t frames_lost_ = 0;
  double masks_s_ = 0.0;
};

std::optional<Eigen::Isometry3d>
TrackedPoses::next (const RgbdFrame& frame)
{
  std::optional<Image<std::uint16_t>> mask;
  addSeconds (masks_s_, [&] { mask = masks_.read (frame); });
  tracked_ = &fusion_.process (frame, mask ? &*mask : nullptr);
  ++frames_;
  frames_lost_ += !tracked_->T_world_camera;
  instances_.reset ();
  if (tracked_->T_world_camera)
    instances_ = tracked_->instances;
  for (const auto& [id, T] : tracked_->T_world_object)
    told_.insert (id);
  return tracked_->T_world_camera;
}

std::string
TrackedPoses::status () const
{
  if (!tracked_)
    return "";
  std::string text;
  if (with_masks_)
    text = std::to_string (fusion_.objects ().size ()) + " objects, ";
  if (tracked_->lost > 0)
    text += std::to_string (tracked_->lost) + " lost, ";
  if (!tracked_->T_world_camera)
    return text + "camera lost";
  return text + "fit " + std::to_string (std::lround (100.0 * tracked_->inlier_share)) + " %";
}

void
TrackedPoses::finish (FusionResult& result)
{
  for (const auto& [stage, seconds] : fusion_.timings ())
    result.timings_s[stage] += seconds;
  result.timings_s["segmentation"] += masks_s_;
  result.tracked = true;
  result.events = fusion_.events ();
  if (frames_lost_ > 0)
    result.warnings.push_back (std::to_string (frames_lost_) + " of " + std::to_string (frames_) +
                               " frames were left out: the camera could not be tracked in them");
  const std::set<int> found = fusion_.foundObjects ();
  for (auto object = result.objects.begin (); object != result.objects.end ();)
  {
    const int id = object->first;
    if (found.count (id) > 0)
    {
      object->second.tsdf = fusion_.surfaceMesh (id);
      object->second.best_class = fusion_.objectClass (id);
      ++object;
      continue;
    }
    auto& completed = result.scene.objects;
    completed.erase (
        std::remove_if (completed.begin (), completed.end (), [id] (const ObjectResult& o) { return o.id == id; }),
        completed.end ());
    object = result.objects.erase (object);
  }
}

} // namespace

std::unique_ptr<FrameContext>
makeTrackedPoses (const TrackedSequence& sequence, const FusionOptions& options)
{
  return std::make_unique<TrackedPoses> (sequence, options);
}

} // namespace pcl::cosection
