// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"

#include <pcl/cosection/common/oriented_point.h>

#include <vector>

namespace pcl::cosection {

/** \brief How wide an object is in its views, on average: twice its area over the length of its outline, which of a
 * band is the width, and of a disc half the diameter.
 * \param[in] points of the object, in the frame of the views' poses
 * \return metres; 0 if no view shows it */
double meanWidth (const SensorViews& views, const std::vector<OrientedPoint>& points);

} // namespace pcl::cosection
