// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "grid_transfer.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Galerkin products of a diagonal matrix: P^T diag (w) P, level by level.
 *
 * The entry between voxels I and J depends, per axis, on min (I, J) and |I - J| only, as tensor
 * products of symmetric one-dimensional pairs do; so 8 values a voxel describe the 27 entries of the
 * first coarse level and 27 values the 125 of the levels below. */
template <typename Real> struct GalerkinWeights
{
  Eigen::Vector3i dims = Eigen::Vector3i::Zero ();
  std::array<int, 3> span{}; ///< largest |I - J| per axis
  std::vector<std::vector<Real>> entries; ///< [(c * (span_y + 1) + b) * (span_x + 1) + a][voxel of min (I, J)]

  const std::vector<Real>&
  entry (int a, int b, int c) const
  {
    return entries[(c * (span[1] + 1) + b) * (span[0] + 1) + a];
  }

  /** \brief Allocate for the level below one with \a fine_span. */
  void
  allocate (const GridTransfer& transfer, const std::array<int, 3>& fine_span);

  /** \brief From a diagonal matrix (packed weights) on the finest level. */
  void
  coarsen (const GridTransfer& transfer, const std::uint16_t* diagonal, int threads);

  /** \brief From the level above. */
  void
  coarsen (const GridTransfer& transfer, const GalerkinWeights& fine, int threads);

  /** \brief out += row (j, k) of the matrix times v. */
  void
  addRowProduct (const Real* v, int j, int k, Real* out) const;

  /** \brief out += sums of the absolute values of row (j, k), an upper bound of its eigenvalues. (At the
   * border interpolation extrapolates, with negative weights.) */
  void
  addAbsoluteRowSums (int j, int k, Real* out) const;

private:
  /** \brief f (first of the row in v, first of the row of entries, |dy|, |dz|) for every row that row
   * (j, k) couples to. */
  template <typename Function> void
  forEachCoupledRow (int j, int k, Function&& f) const;
};

extern template struct GalerkinWeights<float>;
extern template struct GalerkinWeights<double>;

} // namespace cosection
} // namespace pcl
