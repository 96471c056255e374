// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Directions evenly distributed over the sphere, symmetric with respect to the senses of the axes: those of a
 * Fibonacci lattice in one octant, and their mirror images. \param[in] axes columns */
std::vector<Eigen::Vector3d> evenDirections (int count, const Eigen::Matrix3d& axes);

/** \brief Mean normals of all large flat faces, the largest first.
 * \param[in] bins unit directions, evenly distributed over the sphere */
std::vector<Eigen::Vector3d> faceNormals (const std::vector<OrientedPoint>& points,
                                          const std::vector<Eigen::Vector3d>& bins);

/** \brief Whether most points belong to the three largest faces. */
bool prevail (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces);

} // namespace pcl::cosection
