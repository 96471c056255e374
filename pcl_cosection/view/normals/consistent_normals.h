// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/pcd_cloud.h"
#include "pcl_cosection/view/sensor_view.h"

#include <pcl/cosection/io/pcd_view.h>

namespace pcl::cosection {

/** \brief Estimate the normals of an unorganised cloud of which it is not known where it was seen from.
 *
 * Those of neighbours agree (orientConsistently ()). The background faces the objects near it, and these face away from
 * it, as all that was seen of them, also the inside of a bowl, was seen from its outer side; where that does not say
 * enough, bodies are on the inner side. Scattered points of the background near objects, mixed pixels between these and
 * what is behind them, get no normals. */
void addConsistentNormals (const PcdViewOptions& options, const Members& members, SensorCloud& cloud);

} // namespace pcl::cosection
