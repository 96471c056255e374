// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_views.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief An object as a network completes it: closed, in the object's frame, metres. Empty if it expects nothing.
 * \param[in] points of the object
 * \param[in] views of it, and their sensors' poses in its frame
 * \param[in] plane n.x + d = 0 on which it stands, unit n towards it */
TriangleMesh completedByNetwork (const CompletionNetwork& network, const std::vector<OrientedPoint>& points,
                                 const SensorViews& views, const Eigen::Vector4d& plane);

} // namespace pcl::cosection
