// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pcl::cosection {

constexpr double least_wall_vox = 1.25; ///< thickness, in voxels, with which a wall has no holes

} // namespace pcl::cosection
