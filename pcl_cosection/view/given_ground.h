// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

namespace pcl::cosection {

/** \brief In a cloud without labels, make the points on the planes on which things stand, within their noise, the
 * background; the noise is the spread of the points about a plane that has enough of them. */
void labelGround (const PcdViewOptions& options, SensorCloud& cloud);

} // namespace pcl::cosection
