// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/segmentation/moving_body_finder.h>

namespace pcl::cosection
{

/** \brief Finds objects in frames when they begin to move: MovingBodyFinder. What the front end tracks already is known
 * to it; what moves with an object is a part of it. Things that move otherwise than as a whole are ignored.
 *
 * \code
 * fusion.setSegmenter (std::make_shared<MotionSegmenter> ());
 * \endcode */
class PCL_COSECTION_EXPORT MotionSegmenter : public FrameSegmenter
{
public:
  /** \throws InvalidArgument as MotionSegmentationOptions::validate () */
  explicit MotionSegmenter (const MotionSegmentationOptions& options = {});

  void begin () override;

  void look (const ObservedFrame& frame) override;

  FrameInstances segment (const ObservedFrame& frame) override;

  /** \brief What rests is not found. */
  bool findsAll () const override { return false; }

private:
  MovingBodyFinder finder_;
};

} // namespace pcl::cosection
