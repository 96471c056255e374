// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

class InsideBricks;

/** \brief The voxels of a grid that a body's volume covers; empty if it is elsewhere.
 * \param[in] T_body_grid takes the grid's frame to the body's */
Eigen::AlignedBox3i coveredVoxels (const VoxelGrid& grid, const Eigen::Isometry3d& T_body_grid, const VoxelGrid& body);

/** \brief d_inter of equation (4) on an object's grid: how deep each voxel lies inside other bodies, the
 * maximum over bodies and relative poses, in voxels of this grid. */
class IntersectionConstraint
{
public:
  /** \param[in] max_bound_vox cap of the distance */
  IntersectionConstraint (const VoxelGrid& grid, double max_bound_vox, int threads = 0);

  /** \brief Add another body at some poses. It has no effect outside its volume and where it is not supported.
   * \param[in] T_body_grid take this grid's frame to the body's
   * \param[in] beta weight of the constraint where this body's distance is the largest */
  void addBody (const SignedDistanceField& body, const std::vector<Eigen::Isometry3d>& T_body_grid, double beta);

  /** \brief Add the half-space n.x + d < 0 of \a plane (unit normal, this grid's frame), except for voxels seen
   * free. */
  void addHalfSpace (const Eigen::Vector4d& plane, const std::vector<std::uint8_t>& free_space, double beta);

  /** \brief Multiply the weights of everything added so far. */
  void scaleWeights (double factor);

  /** \brief One bound per voxel; empty if no body reaches the volume. */
  std::vector<LowerBound> bounds () const;

private:
  void addBody (const SignedDistanceField& body, const InsideBricks& inside, const Eigen::Isometry3d& T_body_grid,
                float beta);

  void raise (std::size_t n, float distance_vox, float beta);

  VoxelGrid grid_;
  float max_bound_vox_;
  int threads_;
  std::vector<float> distance_vox_; // both empty while no body reaches the volume
  std::vector<float> beta_;
};

} // namespace pcl::cosection
