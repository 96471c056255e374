// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

#include <pcl/cosection/common/export.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <functional>

namespace pcl::cosection {

/** \brief Points as PCL's searches and models take them. */
PCL_COSECTION_EXPORT PointCloud<PointXYZ>::Ptr asCloud (const std::vector<Eigen::Vector3f>& positions);

/** \brief Give points without an order normals by pcl::NormalEstimationOMP, NaN where there is none.
 *
 * Where they are so dense that the nearest ones would show noise alone, means of points in cells stand for them.
 * \param[in] indices of the points
 * \param[in] turn (points, normals): called for those that were estimated, which are of any sign */
void addNormals (const PcdViewOptions& options, const std::vector<std::size_t>& indices, SensorCloud& cloud,
                 const std::function<void (const std::vector<Eigen::Vector3f>& points,
                                           std::vector<Eigen::Vector3f>& normals)>& turn = {});

/** \brief The distance from each point to the \a neighbours-th nearest other place that has any, or the last there is.
 * \a points are finite. */
std::vector<float> neighbourDistances (const std::vector<Eigen::Vector3f>& points, int neighbours, int threads);

} // namespace pcl::cosection
