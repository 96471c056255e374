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

/** \brief Which ways measured points face, by voxel: both sides of a thin wall are near the points of either, but only
 * one may have been seen. */
class NormalBinOccupancy
{
public:
  NormalBinOccupancy () = default;
  NormalBinOccupancy (const VoxelGrid& grid, const std::vector<OrientedPoint>& points);

  /** \brief None were given? */
  bool empty () const { return ways_.empty (); }

  /** \brief Does any point within three voxels face about as \a normal does? */
  bool face (const Eigen::Vector3f& position, const Eigen::Vector3f& normal) const;

private:
  VoxelGrid grid_;
  std::vector<std::uint8_t> ways_; // by voxel, a bit for either sense of each axis
};

} // namespace pcl::cosection
