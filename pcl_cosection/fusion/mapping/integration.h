// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_map.h"
#include "pcl_cosection/fusion/association/frame_labels.h"

#include <pcl/cosection/io/rgbd_sequence.h>

namespace pcl::cosection {

/** \brief Count the pixels of objects that have absorbed others as their foreground: masks before counted the absorbed
 * parts against them. \param[in] whole_of labels by label of an absorbed part */
void countAbsorbed (const PosedFrame& frame, const LabelImage& labels, const LabelMap& whole_of, ObjectMap& objects);

/** \brief Integrate the depth of a frame into the volumes of the background and of tracked objects, and free space into
 * those of the objects; with a mask, count the foreground of all: TsdfVolume.
 * \param[in] images of the frame \param[in] masked a mask has part in the labels */
void integrateFrame (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels, bool masked,
                     TsdfVolume& background, ObjectMap& objects);

} // namespace pcl::cosection
