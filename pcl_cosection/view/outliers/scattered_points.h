// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/object_surroundings.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Take the normals of points of the background near objects that are so much farther from each other than
 * others there that they show no surface. \param[in] background indices of the points near objects */
void leaveOutScattered (const PcdViewOptions& options, const Surroundings& objects,
                        const std::vector<std::size_t>& background, SensorCloud& cloud);

} // namespace pcl::cosection
