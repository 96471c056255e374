// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/visibility/free_space_view.h"
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Votes of depth views on what is free: the complement of the hull of equation (3).
 *
 * A voxel is free in a view when the depth along its ray exceeds its own by more than the margin,
 * max (3 voxels, 3 sigma_z), for every reading in its footprint. Missing readings and pixels at depth
 * edges say nothing, and what lies outside the volume counts as hull. A voxel at a seen surface (within
 * the margin) is a vote against; so a few wrong pixels or a slightly wrong pose can be outvoted. */
class HullConstraint
{
public:
  explicit HullConstraint (const VoxelGrid& grid, int threads = 0);

  /** \brief Add the votes of one view. \param[in] T_grid_sensor pose of the sensor in the grid's frame */
  void add (const FreeSpaceView& view, const Eigen::Isometry3d& T_grid_sensor);

  /** \brief 1 where free.
   * \param[in] revise free means more votes for than against; else one vote suffices for ever (paper) */
  std::vector<std::uint8_t> freeSpace (bool revise) const;

private:
  VoxelGrid grid_;
  int threads_;
  std::vector<std::uint8_t> votes_for_;
  std::vector<std::uint8_t> votes_against_;
};

/** \brief d_hull of equation (3): exact Euclidean distance, in voxels, from free voxels to the hull (to
 * the nearest voxel that is not free; all voxels outside the volume are not); 0 elsewhere. */
std::vector<float> hullDistance (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& free_space,
                                 int threads = 0);

} // namespace pcl::cosection
