// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/segmentation/object_segmentation.h>

#include <memory>

namespace pcl::cosection
{

/** \brief Finds objects in frames by their geometry alone: segmentObjects (). What it misses in one, as things at the
 * image's border or flat ones, it may find in the next; what most frames have shown to be too long for an object is
 * none where another one shows but a part of it.
 *
 * \code
 * fusion.setSegmenter (std::make_shared<GeometricSegmenter> ());
 * \endcode */
class PCL_COSECTION_EXPORT GeometricSegmenter : public FrameSegmenter
{
public:
  /** \throws InvalidArgument as ObjectSegmentationOptions::validate () */
  explicit GeometricSegmenter (const ObjectSegmentationOptions& options = {});

  ~GeometricSegmenter () override;

  void begin () override;

  /** \brief Without a plane that objects could stand on, the frame tells nothing. */
  FrameInstances segment (const ObservedFrame& frame) override;

  bool findsAll () const override { return false; }

  bool isExact () const override { return false; }

private:
  ObjectSegmentationOptions options_;
  std::unique_ptr<class ObjectSizeFilter> too_long_;
};

} // namespace pcl::cosection
