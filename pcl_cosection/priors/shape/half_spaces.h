// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief A convex region, the intersection of half-spaces { x : n_k.x <= s_k }; all of space without any. */
class HalfSpaces
{
public:
  /** \param[in] n unit normal, outwards \param[in] s metres */
  void add (const Eigen::Vector3d& n, double s) { sides_.emplace_back (n, s); }

  bool empty () const { return sides_.empty (); }

  /** \brief max_k (n_k.x - s_k) at the voxels of a row of a grid: at most the signed distance to the region, negative
   * inside; metres. 0 without any. */
  std::vector<float> beyond (const VoxelGrid& grid, int j, int k) const;

private:
  std::vector<std::pair<Eigen::Vector3d, double>> sides_; // n_k, s_k
};

} // namespace pcl::cosection
