// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid_transfer.h"
#include "guarded_field.h"
#include "row_kernels.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Galerkin products of a diagonal matrix: P^T diag (w) P, level by level.
 *
 * The entry between voxels I and J depends, per axis, on min (I, J) and |I - J| only, as tensor
 * products of symmetric one-dimensional pairs do; so 8 values a voxel describe the 27 entries of the
 * first coarse level and 27 values the 125 of the levels below. Most of them are zero, as data and active
 * bounds are thin; products pass over the zeros. */
template <typename Real> struct GalerkinWeights
{
  Eigen::Vector3i dims = Eigen::Vector3i::Zero ();
  std::array<int, 3> span{}; ///< largest |I - J| per axis

  /** \brief The entries between voxels with |I - J| = (a, b, c), by the voxel min (I, J). */
  const Real* entry (int a, int b, int c) const { return entry ((c * (span[1] + 1) + b) * (span[0] + 1) + a); }

  const Real* entry (int index) const { return entries_[index].data (); }

  /** \brief Allocate for the level that is coarser than one with \a fine_span. */
  void allocate (const GridTransfer& transfer, const std::array<int, 3>& fine_span);

  /** \brief Compute P^T diag (w) P from packed weights w on the finest level. */
  void coarsen (const GridTransfer& transfer, const std::uint16_t* diagonal, int threads);

  /** \brief Compute P^T W P from the matrix W of the next finer level. */
  void coarsen (const GridTransfer& transfer, const GalerkinWeights& fine, int threads);

  /** \brief out += row (j, k) of the matrix times v.
   * \param[in] v the values of a GuardedField
   * \param[in,out] out with room for GuardedField::guard values more than a row */
  void addRowProduct (const Real* v, int j, int k, Real* out) const;

  /** \brief out += sums of the absolute values of row (j, k), an upper bound of its eigenvalues. (At the
   * border interpolation extrapolates, with negative weights.) */
  void addAbsoluteRowSums (int j, int k, Real* out) const;

private:
  /** \brief A part of a row with entries that are not zero. */
  struct Run
  {
    int begin;
    int end;
  };

  template <typename PlaneFunction>
  void contract (const GridTransfer& transfer, const std::array<int, 3>& fine_span, int threads, PlaneFunction&& plane);

  std::size_t runCapacity () const { return static_cast<std::size_t> (dims.x ()) / (2 * kernels::run_block) + 1; }

  void findRuns (int threads);

  /** \brief f (row in v, row of entries, |dy|, |dz|) for every row that row (j, k) couples to. */
  template <typename Function> void forEachCoupledRow (int j, int k, Function&& f) const;

  std::vector<GuardedField<Real>> entries_; // [(c * (span_y + 1) + b) * (span_x + 1) + a]
  std::vector<Run> runs_;                   // runCapacity () a row
  std::vector<std::uint16_t> run_count_;    // by row
};

extern template struct GalerkinWeights<float>;
extern template struct GalerkinWeights<double>;

} // namespace pcl::cosection
