// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/pcd_cloud.h"

#include <pcl/cosection/io/pcd_view.h>

#include <string>

namespace pcl::cosection {

/** \brief Give an unorganised cloud normals and, if the points show that the sensor stood at the viewpoint, rays.
 *
 * The viewpoint counts if all points are visible from there, and one that the file leaves at its default only if the
 * points also lie before it as before a camera. Missing normals are estimated, and turned towards the viewpoint, or
 * else consistently and outward. Given normals that the viewpoint or the shape contradict are turned. \a
 * result.warnings says what was turned, if it is more than a few. */
void completeUnorganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud,
                          LabelledView& result);

} // namespace pcl::cosection
