// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Which points of an object lie beside an edge of it, as seen from the sensor, far behind that, and far from
 * others.
 *
 * There a sensor measures what is nowhere, as a trail of points along its rays. In an image these are few pixels; of a
 * cloud that was thinned to one point per cell they are a large share. So none are found in points that are one per
 * pixel.
 * \param[in] points in the frame of the camera, metres \param[in] threads 0: all
 * \return for each point; none if some are not before the camera or not finite */
std::vector<bool> findBehindEdges (const std::vector<Eigen::Vector3f>& points, int threads);

} // namespace pcl::cosection
