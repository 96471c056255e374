// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_context.h"

#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pcl::cosection {
namespace {

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

/** \brief Poses and instances are found by DynamicFusion. */
class TrackedPoses : public FrameContext
{
public:
  TrackedPoses (const TrackedSequence& sequence, const FusionOptions& options)
      : masks_ (sequence.masks)
      , has_objects_ (hasObjects (sequence))
      , fusion_ (sequence.images->camera (), frontEndOptions (sequence, options))
  {
    fusion_.setSegmenter (sequence.segmenter);
  }

  FrameKnowns next (const RgbdFrame& frame) override;

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

  std::string status () const override;

  std::vector<std::string> maskWarnings () const override { return masks_.warnings (); }

  void finish (FusionResult& result) override;

private:
  MaskReader masks_;
  const bool has_objects_;
  DynamicFusion fusion_;
  const TrackedFrame* tracked_ = nullptr; // of the last frame
  std::set<int> tracked_ids_;             // of objects in any frame
  std::size_t frames_ = 0;
  std::size_t frames_lost_ = 0;
  double masks_s_ = 0.0;
};

FrameKnowns
TrackedPoses::next (const RgbdFrame& frame)
{
  std::optional<Image<std::uint16_t>> mask;
  {
    const ScopedSeconds timer (masks_s_);
    mask = masks_.read (frame);
  }
  tracked_ = &fusion_.process (frame, mask ? &*mask : nullptr);
  ++frames_;
  frames_lost_ += !tracked_->T_world_camera;
  for (const auto& [id, T] : tracked_->T_world_object)
    tracked_ids_.insert (id);
  FrameKnowns known;
  known.T_world_camera = tracked_->T_world_camera;
  known.masked = !has_objects_ || tracked_->masked;
  if (known.T_world_camera)
    known.instances = tracked_->instances;
  return known;
}

std::string
TrackedPoses::status () const
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
    if (found.count (id) == 0)
    {
      object = eraseObject (object, true, result);
      continue;
    }
    object->second.tsdf = fusion_.surfaceMesh (id);
    object->second.best_class = fusion_.objectClass (id);
    ++object;
  }
}

} // namespace

std::unique_ptr<FrameContext>
makeTrackedPoses (const TrackedSequence& sequence, const FusionOptions& options)
{
  return std::make_unique<TrackedPoses> (sequence, options);
}

} // namespace pcl::cosection
