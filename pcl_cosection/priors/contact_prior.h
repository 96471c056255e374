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
 * copy is above. The result is the set of voxels next to the plane that should have u = -height, with a weight far
 * below that of data. */
struct ContactPrior
{
  double contact_height_vox = 2.5; ///< largest distance of a contact point from the plane
  double max_slope = 0.7;          ///< largest |n.plane| of the normal n of a contact point
  double gap_per_length = 1.0;     ///< largest gap between a part and its copy, per length of the part
  double max_free_share = 0.1;     ///< of the space 3 to 7 voxels over the plane between a part and its copy, seen free
  int min_contacts = 10;           ///< least number of contact points
  double reach_vox = 2.0;          ///< voxels up to this height above or below the plane are affected

  /** \brief 1 for voxels of the contact patch, 0 for others; empty if the object does not come down to the plane.
   * \param[in] plane (n, d), unit normal towards the object, the grid's frame
   * \param[in] points of the object, the grid's frame
   * \param[in] center of the object's axis, the grid's frame
   * \param[in] free_space 1 where seen free, one per voxel */
  std::vector<std::uint8_t> patch (const VoxelGrid& grid, const Eigen::Vector4d& plane,
                                   const std::vector<OrientedPoint>& points, const Eigen::Vector3d& center,
                                   const std::vector<std::uint8_t>& free_space) const;
};

} // namespace pcl::cosection
