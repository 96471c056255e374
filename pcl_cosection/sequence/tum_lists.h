// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/rgbd_sequence.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The frames of TUM's layout, in the order of the lists; depth may be without colour. \throws IoError */
std::vector<FrameFiles> readTumLists (const std::string& folder, std::vector<std::string>& warnings);

} // namespace pcl::cosection
