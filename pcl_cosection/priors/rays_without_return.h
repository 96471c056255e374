// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "occlusion_map.h"

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief Places that some view looks at, beside an object that was cut out of its scene, without a reading nearer than
 * them: what is beside it was cut away.
 *
 * Missing readings that the object surrounds in the image may be what the sensor does not see of it; they tell nothing,
 * nor does what is out of view.
 * \param[in] views that saw the object, and their sensors' poses in the points' frame \param[in] points the object's
 * \return 1 per voxel that is such a place */
std::vector<std::uint8_t> findRaysWithoutReturn (const VoxelGrid& grid, const OcclusionMap::Views& views,
                                                 const std::vector<OrientedPoint>& points, int threads);

} // namespace pcl::cosection
