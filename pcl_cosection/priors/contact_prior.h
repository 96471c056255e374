// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief Where an object rests on a support plane without our seeing it.
 *
 * Non-intersection says that an object does not enter the table; nothing in it says that the object
 * stands on it, and smoothness alone lifts hidden undersides off. Contact is where observed surface that is not level
 * comes down to the plane; the level inside of a bowl does not. Each connected part K of it is completed by its copy K'
 * that is turned by half a revolution about the object's axis (SymmetricExtent), if the two are no farther apart than K
 * is long: the front and the back edge of a box, but not two wheels of a car; nor if a tenth of the space close over
 * the plane between them was seen free. Below the convex hull of K and K' (of K alone otherwise), where there is
 * observed surface or its copy above, the object is taken to lie on the plane. The result is a set of voxels next to
 * the plane at which u = -height is to be preferred, with a weight far below that of data. */
struct ContactPrior
{
  double contact_height_vox = 2.5; ///< points this near to the plane are contact
  double max_slope = 0.7;          ///< largest |n.plane| of the normal n of a point of contact
  double gap_per_length = 1.0;     ///< largest gap between a part and its copy, per length of the part
  double max_free_share = 0.1;     ///< of the space 3 to 7 voxels over the plane between a part and its copy, seen free
  int min_contacts = 10;           ///< points; and cells of a voxel, of each part
  double reach_vox = 2.0;          ///< voxels up to this height above or below the plane are affected

  /** \brief 1 for voxels of the contact patch, 0 for others; empty if the object does not come down to the plane.
   * \param[in] plane (n, d), unit normal towards the object, the grid's frame
   * \param[in] points the object's, the grid's frame
   * \param[in] center of the object's axis, the grid's frame
   * \param[in] free_space 1 where seen free, one per voxel */
  std::vector<std::uint8_t> patch (const VoxelGrid& grid, const Eigen::Vector4d& plane,
                                   const std::vector<OrientedPoint>& points, const Eigen::Vector3d& center,
                                   const std::vector<std::uint8_t>& free_space) const;
};

} // namespace pcl::cosection
