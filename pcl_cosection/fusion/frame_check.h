// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/fusion/sequence_fusion.h>

namespace pcl::cosection
{

/** \brief What can be known of a sequence's frames before any is read. \throws InvalidArgument if there is no frame in
 * the range, or the ignored pixels are not of the images' size */
void requireFrames (const RgbdSequence& images, const FusionOptions& options);

/** \throws InvalidArgument if no frame of the range has a pose of the camera */
void requirePoses (const KnownSequence& sequence, const FrameRange& frames);

} // namespace pcl::cosection
