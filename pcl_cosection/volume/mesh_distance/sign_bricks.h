// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Which bricks of a field have a surface, perhaps, and how far it is from the others to those.
 *
 * A brick is a cube of cells; a cell lies between eight voxels. Where a field that is interpolated in cells passes
 * zero, the brick has positive voxels and others. */
class SignBricks
{
public:
  static constexpr int edge = 4;         ///< cells
  static constexpr int max_distance = 8; ///< bricks

  SignBricks (const SignedDistanceField& field, int threads);

  /** \brief 0: both signs are in this brick; n: in none of those that are less than n bricks away along each axis. */
  int distance (int i, int j, int k) const { return distances_[index (i, j, k)]; }

  /** \brief Index of the brick that a cell is in. */
  int distanceAt (std::size_t i, std::size_t j, std::size_t k) const
  {
    return distances_[index (i / edge, j / edge, k / edge)];
  }

  /** \brief Corners of the smallest box around all bricks with both signs, voxel coordinates; turned around if no
   * brick has both. */
  std::array<Eigen::Vector3d, 2> surfaceBox () const;

private:
  std::size_t index (std::size_t i, std::size_t j, std::size_t k) const
  {
    return (k * dims_.y () + j) * dims_.x () + i;
  }

  /** \brief 1 for bricks of both signs. */
  std::vector<std::uint8_t> findMixed (const SignedDistanceField& field, int threads) const;

  Eigen::Vector3i dims_; ///< bricks
  Eigen::Vector3d last_voxel_;
  std::vector<std::uint8_t> distances_;
};

} // namespace pcl::cosection
