// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Depth views of a body, and the poses of their sensors in its frame. */
using SensorViews = std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>;

} // namespace pcl::cosection
