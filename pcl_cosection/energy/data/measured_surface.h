// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pcl::cosection
{

/** \brief Tells points of a body's surface, by those that were measured of it. */
class MeasuredSurface
{
public:
  static constexpr double voxels_deep = 5.0; ///< what is asked for lies no deeper
  static constexpr double voxels_beside = 2.0;

  /** \param[in] points must outlive this */
  MeasuredSurface (const std::vector<OrientedPoint>& points, double voxel_size_m);

  /** \brief Whether \a point faces as one of the body's does, to 60 degrees, and is beside it: up to voxels_beside from
   * its normal's line and above it, \a depth_vox below. \param[in] point the body's frame \param[in] depth_vox
   * voxels_deep at most */
  bool has (const OrientedPoint& point, double depth_vox) const;

private:
  const std::vector<OrientedPoint>& points_;
  double voxel_size_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_; // of voxels_deep: points
};

} // namespace pcl::cosection
