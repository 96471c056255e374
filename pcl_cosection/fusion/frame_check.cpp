// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "frame_check.h"

#include "pcl_cosection/sequence/stamp_span.h"

#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>

namespace pcl::cosection
{

void
requireFrames (const RgbdSequence& images, const FusionOptions& options)
{
  const FrameRange& frames = options.frames;
  const Image<std::uint8_t>& ignored = options.ignored;
  const PinholeCamera& camera = images.camera ();
  if (!ignored.pixels.empty () && (ignored.width != camera.width || ignored.height != camera.height))
    throw InvalidArgument ("the ignored pixels fill an image of " + std::to_string (ignored.width) + " x " +
                           std::to_string (ignored.height) + ", those of the sequence one of " +
                           std::to_string (camera.width) + " x " + std::to_string (camera.height));
  if (frames.first >= std::min (frames.last, images.size ()))
    throw InvalidArgument ("the frames from " + std::to_string (frames.first) +
                           " on are not there; the sequence has 0:" + std::to_string (images.size ()));
}

void
requirePoses (const KnownSequence& sequence, const FrameRange& frames)
{
  const std::vector<double> stamps = sequence.images->stamps ();
  const std::size_t last = std::min (frames.last, stamps.size ());
  const auto begin = stamps.begin () + static_cast<std::ptrdiff_t> (frames.first);
  const std::vector<double> used (begin, stamps.begin () + static_cast<std::ptrdiff_t> (last));
  const auto poses = posesAtStamps (sequence.camera, used, sequence.images->period ());
  if (std::none_of (poses.begin (), poses.end (), [] (const auto& pose) { return pose.has_value (); }))
    throw InvalidArgument ("the camera's trajectory has no pose for any frame: its stamps are " +
                           stampSpan (sequence.camera.front ().stamp, sequence.camera.back ().stamp) +
                           ", those of the frames " + stampSpan (used.front (), used.back ()) +
                           "; they must be within half a frame of each other");
}

} // namespace pcl::cosection
