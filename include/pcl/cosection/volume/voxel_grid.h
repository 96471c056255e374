// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace pcl::cosection
{

/** \brief A regular grid of cubic voxels, axis-aligned in its reference frame. Values live at voxel
 * centres; x varies fastest. */
struct VoxelGrid
{
  Eigen::Vector3i dims = Eigen::Vector3i::Zero ();     ///< voxels along x, y, z
  double voxel_size_m = 0.0;                           ///< edge of a voxel
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero (); ///< centre of voxel (0, 0, 0)

  std::size_t size () const { return static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (); }

  std::size_t index (int i, int j, int k) const
  {
    return (static_cast<std::size_t> (k) * dims.y () + j) * dims.x () + i;
  }

  Eigen::Vector3d center (int i, int j, int k) const { return origin_m + voxel_size_m * Eigen::Vector3d (i, j, k); }

  /** \brief Continuous voxel coordinates; voxel (i, j, k) has its centre at (i, j, k). */
  Eigen::Vector3d toVoxel (const Eigen::Vector3d& p) const { return (p - origin_m) / voxel_size_m; }

  /** \brief The voxel with the nearest centre; nothing outside the grid, however far, and for NaN. */
  std::optional<Eigen::Vector3i> nearest (const Eigen::Vector3d& p) const
  {
    const Eigen::Array3d v = toVoxel (p).array ();
    if (!((v >= -0.5).all () && (v < dims.cast<double> ().array () - 0.5).all ()))
      return std::nullopt;
    return Eigen::Vector3i (v.round ().cast<int> ().max (0).min (dims.array () - 1));
  }

  bool contains (int i, int j, int k) const
  {
    return i >= 0 && j >= 0 && k >= 0 && i < dims.x () && j < dims.y () && k < dims.z ();
  }
};

} // namespace pcl::cosection
