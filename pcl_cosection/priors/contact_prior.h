// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief The hidden contact of an object with its support plane.
 *
 * Non-intersection keeps an object out of the table, but nothing makes it stand there, and smoothness alone lifts
 * hidden undersides off. Contact is where observed surface comes down to the plane, unless it is horizontal, such as
 * the inside of a bowl. Each connected part K of it is completed by its copy K' by a half turn about the object's axis
 * (SymmetricExtent), if the gap between the two is no longer than K (the front and the back edge of a box, but not two
 * wheels of a car) and less than a tenth of the space close over the plane between them was seen free. The object is
 * taken to lie on the plane below the convex hull of K and K' (otherwise of K alone), where observed surface or its
 * copy is above.
 * \param[in] plane (n, d), unit normal towards the object, the grid's frame
 * \param[in] points of the object, the grid's frame
 * \param[in] center of the object's axis, the grid's frame
 * \param[in] free_space 1 where seen free, one per voxel
 * \return 1 for voxels next to the plane that should have u = -height, with a weight far below that of data, 0 for
 * others; empty if the object does not come down to the plane */
std::vector<std::uint8_t> contactPatch (const VoxelGrid& grid, const Eigen::Vector4d& plane,
                                        const std::vector<OrientedPoint>& points, const Eigen::Vector3d& center,
                                        const std::vector<std::uint8_t>& free_space);

} // namespace pcl::cosection
