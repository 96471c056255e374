// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_columns.h"
#include "sensor_cloud.h"

#include <Eigen/Geometry>

#include <array>
#include <string>

namespace pcl::cosection {

/** \brief Take coordinates that are too far from their origin for single precision to another one.
 *
 * Floats keep 24 bits: in survey coordinates, some 5000 km from their origin, half a metre. So points that are so far
 * from the sensor that a float would lose their shape are not in its frame: they are in the world's, and the sensor is
 * where VIEWPOINT says, if that is near them, or else nowhere; and the world's origin is moved near the points where
 * meshes in floats would lose theirs. \a cloud has its pose, and gets another one and the origin.
 * \return T_sensor_points, with the scale
 * \throws IoError if the file itself has rounded its coordinates so much that their shape is lost */
Eigen::Affine3d takeToLocalOrigin (const std::string& path, const std::array<const CloudField*, 3>& fields,
                                   const std::array<CloudColumn, 3>& columns, const PcdViewOptions& options,
                                   SensorCloud& cloud);

} // namespace pcl::cosection
