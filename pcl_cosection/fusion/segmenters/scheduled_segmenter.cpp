// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "scheduled_segmenter.h"

#include <pcl/cosection/common/error.h>

#include <utility>

namespace pcl::cosection
{

void
ScheduledSegmenter::set (std::shared_ptr<FrameSegmenter> segmenter)
{
  segmenter_ = std::move (segmenter);
  next_ = 0;
  told_.clear ();
  if (segmenter_)
    segmenter_->begin ();
}

FrameInstances
ScheduledSegmenter::see (const ObservedFrame& frame, EventLog& log)
{
  if (frame.images.index < next_)
  {
    segmenter_->look (frame);
    return {};
  }
  next_ = frame.images.index + every_;
  FrameInstances found = segmenter_->segment (frame);
  if (!found.note.empty () && told_.insert (found.note).second)
    log.add (frame.images.stamp, found.note);
  if (found.mask && (found.mask->width != frame.camera.width || found.mask->height != frame.camera.height))
    throw InvalidArgument ("a segmenter's mask must be of the camera's size");
  for (const auto& [instance, detected] : found.classes)
    if (!(detected.score >= 0.0 && detected.score <= 1.0))
      throw InvalidArgument ("a segmenter's scores must be in [0, 1]");
  return found;
}

} // namespace pcl::cosection
