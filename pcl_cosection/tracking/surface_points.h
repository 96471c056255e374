// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Points on the zero level set, the field's frame: where edges between neighbouring voxels cross it, by linear
 * interpolation; about a voxel apart. Edges to voxels that are not finite or not supported have none. In the order of
 * the voxels. */
PCL_COSECTION_EXPORT std::vector<Eigen::Vector3f> surfacePoints (const SignedDistanceField& field);

} // namespace pcl::cosection
