// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/cloud/sensor_cloud.h"

#include <pcl/cosection/io/pcd_view.h>

#include <string>

namespace pcl::cosection {

/** \brief An unorganised cloud that was put together from several views, whose points are still in their order
 * (beginningsOfViews ()): each is completed as a view of its own, from where its order says that it was seen.
 * \return whether it is one and the place of each view was found; else nothing is changed */
bool completeMerged (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result);

} // namespace pcl::cosection
