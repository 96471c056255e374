// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection
{

/** \brief Directions evenly over the sphere, the same for either sense of each axis: those of a Fibonacci lattice in
 * one octant, and their mirror images. \param[in] axes columns */
std::vector<Eigen::Vector3d> evenDirections (int count, const Eigen::Matrix3d& axes);

/** \brief Mean normals of all large patches that face one way, the largest first. \param[in] bins unit directions,
 * evenly over the sphere */
std::vector<Eigen::Vector3d> faceNormals (const std::vector<OrientedPoint>& points,
                                          const std::vector<Eigen::Vector3d>& bins);

/** \brief Do the largest few faces make up most of the points? */
bool prevail (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces);

/** \brief Do nearly all points belong to faces at right angles, of two directions at least? */
bool isCuboid (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces);

} // namespace pcl::cosection
