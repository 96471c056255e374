// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Which points of a surface lie beside an edge of it, as seen from the sensor, and far behind that.
 *
 * There a sensor measures what is nowhere, as a trail of points along its rays. In a cloud that was thinned to one point per cell there are as many of
 * them as of the surface. The surface itself may be left out there, as far as to the next point.
 * \param[in] points in the frame of the camera, metres \param[in] threads 0: all
 * \return for each point; none if some are not before the camera or not finite */
std::vector<bool>
findBehindEdges (const std::vector<Eigen::Vector3f>& points, int threads);

} // namespace cosection
} // namespace pcl
