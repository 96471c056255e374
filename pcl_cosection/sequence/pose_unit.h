// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Why the positions of a camera are not in metres, as the depth: between most frames it would move farther than
 * what it sees is away. Empty if it does not, or most frames have no pose. Reads depth images up to the first with
 * readings.
 * \param[in] trajectory by ascending stamps */
PCL_COSECTION_EXPORT std::string unitFault (const std::vector<StampedPose>& trajectory, const RgbdSequence& images,
                                            const FrameRange& range);

} // namespace pcl::cosection
