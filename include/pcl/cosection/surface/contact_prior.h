// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/surface/oriented_point.h>
#include <pcl/cosection/volume/voxel_grid.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Where an object rests on a support plane without our seeing it.
 *
 * Non-intersection says that an object does not enter the table; nothing in it says that the object
 * stands on it, and smoothness alone lifts hidden undersides off. If the observed surface comes down to
 * the plane, the hidden part of the plane straight below observed surface is taken as the object's
 * underside, as far to either side as the observed contact reaches, and no farther behind it than it is
 * wide. The result is a set of voxels next to
 * the plane at which u = -height is to be preferred, with a weight far below that of data. */
struct PCL_COSECTION_EXPORT ContactPrior
{
  double contact_height_vox = 2.5; ///< points this near to the plane are contact
  double depth_per_width = 1.0;    ///< depth of the hidden contact per width of the observed one
  int min_contacts = 10;           ///< points
  double reach_vox = 2.0;          ///< voxels up to this height above or below the plane are affected

  /** \brief 1 for voxels of the contact patch, 0 for others; empty if the object does not come down to the plane.
   * \param[in] plane (n, d), unit normal towards the object, the grid's frame
   * \param[in] points the object's, the grid's frame
   * \param[in] sensor_m position from which the points were seen, the grid's frame
   * \param[in] free_space 1 where seen free, one per voxel */
  std::vector<std::uint8_t>
  patch (const VoxelGrid& grid, const Eigen::Vector4d& plane, const std::vector<OrientedPoint>& points,
         const Eigen::Vector3d& sensor_m, const std::vector<std::uint8_t>& free_space) const;
};

} // namespace cosection
} // namespace pcl
