// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scheduled_segmenter.h"

#include "pcl_cosection/fusion/association/unreliable_mask.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {

FrameInstances
ScheduledSegmenter::see (const ObservedFrame& frame, EventLog& log)
{
  if (frame.images.index < next_frame_)
  {
    segmenter_->look (frame);
    return {};
  }
  next_frame_ = frame.images.index + every_;
  FrameInstances found = segmenter_->segment (frame);
  if (!found.note.empty () && logged_notes_.insert (found.note).second)
    log.add (frame.images.stamp, found.note);
  if (found.mask && (found.mask->width != frame.camera.width || found.mask->height != frame.camera.height))
    throw InvalidArgument ("a segmenter's mask must be of the camera's size");
  for (const auto& [instance, detected] : found.classes)
    if (!(detected.score >= 0.0 && detected.score <= 1.0))
      throw InvalidArgument ("a segmenter's scores must be in [0, 1]");
  return found;
}

std::optional<FrameMask>
detectInstances (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels, const MovingParts& moving,
                 const FusionSetup& setup, ObjectMap& objects, ScheduledSegmenter& segmenter, EventLog& log)
{
  if (!segmenter.isSet ())
    return std::nullopt;
  const Image<std::uint8_t> moving_pixels = movingPixels (moving, frame.cloud, labels);
  ObservedFrame observed{images, setup.camera, frame.cloud.points, frame.T_world_camera, {}, labels, moving_pixels};
  for (const auto& [id, object] : objects.by_id)
    if (object.isTracked ())
      observed.T_world_object[id] = object.T_world_object;
  FrameInstances found = segmenter.see (observed, log);
  if (!found.mask)
    return std::nullopt;
  if (segmenter.isExact ())
    return FrameMask{std::move (*found.mask), std::move (found.classes), true, segmenter.findsAll ()};
  const ReconciledMask reconciled = reconcile (*found.mask, labels, moving_pixels, frame.cloud);
  confirmObjects (frame.stamp, reconciled, labels, setup, objects, log);
  const std::set<int> moved = objects.idsOf (
      [] (const TrackedObject& object) { return object.isTracked () && object.hasMoved (); });
  Image<std::uint16_t> attached = attachToMoved (reconciled, moved, labels, frame.cloud);
  std::map<std::uint16_t, ClassScore> classes = carriedClasses (found, attached, frame.cloud);
  return FrameMask{std::move (attached), std::move (classes), false, segmenter.findsAll ()};
}

} // namespace pcl::cosection
