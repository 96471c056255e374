// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Points and their normals, NaN where there is none. */
struct EstimatedNormals
{
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals; ///< of any sign
  std::vector<std::uint32_t> of;        ///< which one stands for each of the points that were given
};

/** \brief Normals of points without an order, by pcl::NormalEstimationOMP.
 *
 * Where they are so dense that the nearest ones would show noise alone, means of points in cells stand for them. */
EstimatedNormals estimateNormals (const PcdViewOptions& options, const std::vector<Eigen::Vector3f>& positions);

/** \brief The distance from each point to the \a neighbours-th nearest other place that has any, or the last there is.
 * \a points are finite. */
std::vector<float> neighbourDistances (const std::vector<Eigen::Vector3f>& points, int neighbours, int threads);

} // namespace pcl::cosection
