// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

namespace pcl::cosection {

/** \brief Some points without those that repeat others, as where clouds were merged: they would pass for denser ones.
 *
 * Points at one place are one, and so are points that are much nearer to each other than to those around, if there are
 * many such; a few are so by chance.
 *
 * \param[in] indices of finite \a positions, rising
 * \return those of them that stay: of points that repeat each other, the first */
std::vector<std::size_t> withoutRepeated (const std::vector<std::size_t>& indices,
                                          const std::vector<Eigen::Vector3f>& positions, int threads);

/** \brief Leave out points that repeat others of their label.
 * \param[in,out] cloud whose repeated points get positions that are not finite
 * \return their share of the finite points */
double leaveOutRepeated (int threads, SensorCloud& cloud);

} // namespace pcl::cosection
