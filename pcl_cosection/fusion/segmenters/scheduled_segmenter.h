// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/association/instance_matching.h"
#include "pcl_cosection/fusion/mapping/moving_parts.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace pcl::cosection {

/** \brief A segmenter, if there is one, and when it is asked for objects. */
class ScheduledSegmenter
{
public:
  /** \param[in] every frames \param[in] segmenter null: none */
  explicit ScheduledSegmenter (int every, std::shared_ptr<FrameSegmenter> segmenter = {})
      : every_ (static_cast<std::size_t> (every))
      , segmenter_ (std::move (segmenter))
  {
    if (segmenter_)
      segmenter_->begin ();
  }

  bool isSet () const { return segmenter_ != nullptr; }

  bool findsAll () const { return !segmenter_ || segmenter_->findsAll (); }

  bool isExact () const { return !segmenter_ || segmenter_->isExact (); }

  /** \brief Show a frame to the segmenter. \return the instances in it; no mask: it is not the segmenter's turn, or it
   * finds nothing out
   * \throws InvalidArgument if they are not of the camera's size, or the score of a class is not in [0, 1] */
  FrameInstances see (const ObservedFrame& frame, EventLog& log);

private:
  std::size_t every_;
  std::shared_ptr<FrameSegmenter> segmenter_;
  std::size_t next_frame_ = 0;
  std::set<std::string> logged_notes_;
};

/** \brief The instances that a segmenter finds in a frame; nothing: it was not asked, or found nothing out. A mask that
 * is not exact is reconciled with the labels, and confirms objects that an earlier one has shown. */
std::optional<FrameMask> detectInstances (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels,
                                          const MovingParts& moving, const FusionSetup& setup, ObjectMap& objects,
                                          ScheduledSegmenter& segmenter, EventLog& log);

} // namespace pcl::cosection
