// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sensor_views.h"

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief The working range of the sensor that gave these readings, if nobody says what it is: that with which the
 * expected noise is the least share of the median distance, as sensors are used where they are best. So the noise that
 * is expected of a scene grows with the scene.
 * \param[in] distances_m of what was measured; not positive or not finite: no reading
 * \return 1 if there is no reading */
double workingRange (std::vector<float> distances_m);

/** \brief Standard deviation of the depth of a place in the view that shows it from the least distance; 0 if no view
 * shows it. */
double noiseAt (const Eigen::Vector3d& place, const SensorViews& views);

} // namespace pcl::cosection
