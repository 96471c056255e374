// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief How far each brick of a block is from the nearest that is marked, in bricks, as a king moves: 0 for those, \a
 * max_distance at most.
 * \param[in] marked 1 or 0, row by row \param[in] dims bricks along each axis */
std::vector<std::uint8_t> brickDistances (std::vector<std::uint8_t> marked, const Eigen::Vector3i& dims,
                                          int max_distance);

/** \brief Tells how far one may go in a field without coming to where SignedDistanceField::sampleInside () has a value.
 */
class InsideBricks
{
public:
  InsideBricks (const SignedDistanceField& field, int threads);

  /** \brief Whether there is a value anywhere. */
  bool any () const { return any_; }

  /** \brief At voxel coordinates: nothing is within so many voxels along each axis; -1: something may be here, or these
   * are outside the field. */
  int emptyVoxels (const Eigen::Vector3d& v) const
  {
    if (!((v.array () >= 0.0).all () && (v.array () <= last_voxel_).all ()))
      return -1;
    const Eigen::Array3i nearest = (v.array () + 0.5).cast<int> () / edge;
    return (distances_[(static_cast<std::size_t> (nearest.z ()) * dims_.y () + nearest.y ()) * dims_.x () +
                       nearest.x ()] -
            1) *
           edge;
  }

private:
  static constexpr int edge = 4; // voxels

  Eigen::Vector3i dims_; // bricks
  Eigen::Array3d last_voxel_;
  std::vector<std::uint8_t> distances_;
  bool any_ = false;
};

} // namespace pcl::cosection
