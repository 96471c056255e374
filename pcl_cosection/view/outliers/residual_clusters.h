// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <vector>

namespace pcl::cosection {

/** \brief Where points were taken away, take what is left of the same thing as well: patches that are connected over
 * cells of \a cell_m, and have fewer points than were taken from their cells and those beside. O (points).
 * \param[in,out] taken by point */
void addResidualClusters (const std::vector<OrientedPoint>& points, double cell_m, std::vector<bool>& taken);

} // namespace pcl::cosection
