// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/mapping/class_evidence.h"
#include <pcl/cosection/common/image.h>

#include <cstdint>
#include <map>

namespace pcl::cosection {

/** \brief One label per pixel: the id of an object, 0: background or no reading, TrackedFrame::unassigned. */
using LabelImage = Image<std::uint16_t>;

/** \brief Labels by label or by instance. */
using LabelMap = std::map<std::uint16_t, std::uint16_t>;

/** \brief The instances of a frame, of a mask that was given or by a segmenter. */
struct FrameMask
{
  Image<std::uint16_t> instances;              ///< number per pixel, 0: none, FrameSegmenter::ignored
  std::map<std::uint16_t, ClassScore> classes; ///< of instances, where they are known
  bool exact = true;                           ///< instances are objects: FrameSegmenter::isExact ()
  bool shows_all = true;                       ///< FrameSegmenter::findsAll ()
};

} // namespace pcl::cosection
