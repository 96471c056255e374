// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/pcd_cloud.h"

#include <pcl/cosection/io/pcd_view.h>

#include <string>

namespace pcl::cosection {

/** \brief Give an organised cloud rays and normals, those of the file if any are not used.
 *
 * The camera is fitted to the points; if they are in another frame than the sensor's, so is its pose, and the points
 * are taken to the sensor. Labels of which too little has a reliable normal (computeOrganizedNormals ()), as with many
 * missing readings, get those of points without an order. \a result.warnings says what is not as in the header. */
void completeOrganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud,
                        LabelledView& result);

} // namespace pcl::cosection
