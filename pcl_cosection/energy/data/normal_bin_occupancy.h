// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Directions of the normals of measured points, in six bins per voxel. Both sides of a thin wall are near the
 * points of either side; the normals show which of them was seen. */
class NormalBinOccupancy
{
public:
  NormalBinOccupancy () = default;
  NormalBinOccupancy (const VoxelGrid& grid, const std::vector<OrientedPoint>& points);

  /** \brief Whether no points were given. */
  bool empty () const { return ways_.empty (); }

  /** \brief Whether a point within three voxels has about the same normal as \a normal. */
  bool face (const Eigen::Vector3f& position, const Eigen::Vector3f& normal) const;

private:
  VoxelGrid grid_;
  std::vector<std::uint8_t> ways_; // by voxel, a bit for each sense of each axis
};

} // namespace pcl::cosection
