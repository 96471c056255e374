// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pcl::cosection {

/** \brief Decides whether a point belongs to the surface of a body, by the body's measured points. */
class MeasuredSurface
{
public:
  static constexpr double voxels_deep = 5.0; ///< largest depth_vox of has ()
  static constexpr double voxels_beside = 2.0;

  /** \param[in] points must outlive this */
  MeasuredSurface (const std::vector<OrientedPoint>& points, double voxel_size_m);

  /** \brief Whether \a point lies near a point of the body whose normal differs by at most 60 degrees: up to
   * voxels_beside from the line of that normal, and from voxels_beside above to \a depth_vox below it.
   * \param[in] point the body's frame
   * \param[in] depth_vox at most voxels_deep */
  bool has (const OrientedPoint& point, double depth_vox) const;

private:
  const std::vector<OrientedPoint>& points_;
  double voxel_size_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_; // points by cell of voxels_deep
};

} // namespace pcl::cosection
