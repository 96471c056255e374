// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Voxels on rays without return: beside an object that was cut out of its scene, in view, and without a reading
 * in front of them. The readings beside the object were cut away, so no part of the object is there.
 *
 * Missing readings inside the object's outline in the image do not count, as the sensor may miss parts of the object.
 * \param[in] views of the object, and their sensors' poses in the points' frame
 * \param[in] points of the object
 * \return 1 for such voxels, 0 for others */
std::vector<std::uint8_t> findRaysWithoutReturn (const VoxelGrid& grid, const SensorViews& views,
                                                 const std::vector<OrientedPoint>& points, int threads);

} // namespace pcl::cosection
