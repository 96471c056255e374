// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/volume/voxel_grid.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief A signed distance sampled on a grid: metres, positive outside, negative inside. */
struct PCL_COSECTION_EXPORT SignedDistanceField
{
  using Ptr = std::shared_ptr<SignedDistanceField>;
  using ConstPtr = std::shared_ptr<const SignedDistanceField>;

  VoxelGrid grid;
  std::vector<float> values;           ///< metres, one per voxel
  std::vector<std::uint8_t> supported; ///< 1 where the value is evidence rather than extrapolation; empty: everywhere

  /** \brief Trilinear interpolation at \a p (metres, the grid's frame); nothing outside the voxel
   * centres' box. */
  std::optional<float> sample (const Eigen::Vector3d& p) const;

  /** \brief As sample (), and nothing where the nearest voxel is not supported. */
  std::optional<float> sampleSupported (const Eigen::Vector3d& p) const;

  /** \brief As sampleSupported (), but only values below zero, at voxel coordinates; quick where there are none. Of a
   * field that grows by no more than three times the distance. */
  std::optional<float> sampleInside (const Eigen::Vector3d& v) const;

  /** \brief Whether sampleInside () may have a value where voxel \a n is the nearest. */
  bool mayBeInside (std::size_t n) const
  {
    constexpr float surely_outside_voxels = 3.0f; // that a value must exceed for all around it to be positive: more
                                                  // than a cell's diagonal
    return (supported.empty () || supported[n] != 0) &&
           !(values[n] > surely_outside_voxels * static_cast<float> (grid.voxel_size_m));
  }

private:
  /** \brief As sample (), at voxel coordinates. */
  std::optional<float> sampleVoxel (const Eigen::Vector3d& v) const;
};

} // namespace pcl::cosection
