// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/pcd_cloud.h"

namespace pcl::cosection {

/** \brief Take the normals of points of the background at depth edges, so that they are left out: between something and
 * what is behind it a sensor measures what is nowhere, and walls of such points would stand between things. Those of
 * objects are too few to do without. */
void leaveOutMixedPixels (const DepthView& view, SensorCloud& cloud);

} // namespace pcl::cosection
