// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/rgbd_sequence.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The frames that a folder holds. */
struct SequenceListing
{
  SequenceFormat format = SequenceFormat::Detect;
  std::string folder;            ///< where they are: a folder in that which was given, if that has nothing else
  std::vector<FrameFiles> files; ///< one or more, by ascending stamps
  std::string trajectory;        ///< path of the poses of the frames, in their order; empty: none
  std::vector<std::string> warnings;
};

/** \brief List the frames of a folder. \throws IoError if there are none */
SequenceListing listSequence (const std::string& folder, const SequenceSource& source);

} // namespace pcl::cosection
