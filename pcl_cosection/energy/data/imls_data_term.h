// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <vector>

namespace pcl::cosection {

/** \brief Where the Gaussian of a point is cut off, in its widths. */
constexpr double cutoff_sigmas = 3.0;

/** \brief The data term of equation (2), gathered on a grid: per voxel x and over the points within
 * 3 sigma, with w_i (x) = a_i exp (-(|x - p_i| / sigma)^2) and f_i (x) = <x - p_i, n_i>. Lengths in voxels. */
struct ImlsDataTerm
{
  std::vector<float> weight;          ///< sum w_i
  std::vector<float> weighted_target; ///< sum w_i f_i, voxels
  std::vector<float> count;           ///< points within 3 sigma

  /** \brief Accumulate \a points (metres, the grid's frame; those without finite coordinates are left
   * out). The sums do not depend on the number of threads.
   * \param[in] sigma_vox width of the Gaussian in voxels, in (0, 10]
   * \param[in] threads 0: all */
  void add (const VoxelGrid& grid, const std::vector<OrientedPoint>& points, double sigma_vox, int threads = 0);

  /** \brief Divide the sums by the count in place (Weighting::Mean), or keep them (Weighting::Sum). Frees the count. */
  void finish (Weighting weighting);

  /** \brief Write the sums divided by the count (Weighting::Mean), or the sums, to other fields; points can still be
   * added afterwards. */
  void average (Weighting weighting, std::vector<float>& averaged_weight, std::vector<float>& averaged_target,
                int threads = 0) const;
};

} // namespace pcl::cosection
