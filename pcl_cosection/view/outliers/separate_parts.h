// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

namespace pcl::cosection {

/** \brief Take the normals of what no surface connects with the largest part of an unorganised object, if it is little:
 * of what is behind an object that was cut out a little too large.
 * \param[in] indices of the points of the object \param[in,out] cloud in the frame of its sensor
 * \return the share of the points that is left out */
double leaveOutSeparateParts (const PcdViewOptions& options, const std::vector<std::size_t>& indices,
                              SensorCloud& cloud);

} // namespace pcl::cosection
