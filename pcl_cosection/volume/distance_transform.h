// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Exact Euclidean distance, in voxels, from every voxel centre to the nearest voxel whose
 * \a mask is not 0 (P. Felzenszwalb, D. Huttenlocher, "Distance Transforms of Sampled Functions",
 * Theory of Computing 2012). Infinity everywhere if there is none. O (voxels).
 * \param[in] mask one value per voxel
 * \param[in] threads 0: all */
std::vector<float> distanceTransform (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& mask,
                                      int threads = 0);

} // namespace pcl::cosection
