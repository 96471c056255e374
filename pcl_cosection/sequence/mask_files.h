// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/rgbd_sequence.h>

#include <map>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The masks that a folder holds. */
struct MaskFiles
{
  bool per_instance = false;
  std::map<double, std::vector<MaskFile>> by_stamp; ///< one file of each stamp, or one per instance
  std::vector<std::string> warnings;
};

/** \brief List the masks of a folder for frames:
 * * MaskNNNN.png, or other names that end in the number or stamp of a frame; where several files have the same number,
 *   those that begin with "mask"
 * * FRAME_INSTANCE.png, instances from 0
 * * OBJECT_FRAME.png, if each object has a mask of each frame: objects are numbers, or names in the order of the
 *   alphabet, and their masks have one value
 * \param[in] stamps of the frames, ascending \param[in] limit how far a number may be from a stamp
 * \throws IoError if there are none, or several for one frame otherwise */
MaskFiles listMaskFiles (const std::string& folder, const std::vector<double>& stamps, double limit);

} // namespace pcl::cosection
