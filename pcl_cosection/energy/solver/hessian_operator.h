// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace pcl::cosection {

namespace kernels {
template <typename Real> struct HessianDiagonal;
}

/** \brief H^T H: the derivative of ||H u||_F^2 / 2, the regulariser of equation (2), on a regular grid
 * in voxel units.
 *
 * Second differences at nodes (interior along their own axis only) and compact mixed differences on
 * 2x2 cell faces,
 *
 *     ||H u||^2 = sum (D_xx u)^2 + (D_yy u)^2 + (D_zz u)^2 + 2 ((D_xy u)^2 + (D_xz u)^2 + (D_yz u)^2),
 *
 * so that affine fields have zero energy, also at the border. With K_a the one-dimensional
 * first-difference Gram matrix along axis a, the operator equals
 *
 *     (K_x + K_y + K_z)^2 - B_x - B_y - B_z,
 *
 * where B_a is the Gram matrix of the first and last first difference along a: the squared 7-point
 * Laplacian with natural boundary, less a correction in the two outermost layers. That is how it is
 * applied: two passes of seven points, fused over three planes. In the interior its row has 25 entries:
 * 42, -12 (faces), +2 (edges), +1 (distance two). Instantiated for float and double. */
template <typename Real> class HessianOperator
{
public:
  /** \param[in] threads 0: all */
  explicit HessianOperator (const Eigen::Vector3i& dims, int threads = 0);

  /** \brief out = H^T H u; both of one value per voxel. */
  void apply (const std::vector<Real>& u, std::vector<Real>& out) const;

  /** \brief The diagonal of H^T H, one value per voxel. */
  std::vector<Real> diagonal () const;

  /** \brief The diagonal of row (j, k), in the form in which the fused operations use it. */
  kernels::HessianDiagonal<Real> diagonal (int j, int k) const;

  /** \brief Call \a row (j, k, values) with every row of H^T H u. Rows of one plane come in order; planes
   * are divided among the threads. Used with operations that are fused to the product. */
  template <typename RowFunction> void forEachRow (const Real* u, RowFunction&& row) const;

  /** \brief Also call \a finished (k) once for every plane k, as soon as no later row depends on u there: u may then
   * be overwritten in that plane, while it is still in the cache. */
  template <typename RowFunction, typename PlaneFunction>
  void forEachRow (const Real* u, RowFunction&& row, PlaneFunction&& finished) const;

  const Eigen::Vector3i& dims () const { return dims_; }

  int threads () const { return threads_; }

private:
  Eigen::Vector3i dims_;
  int threads_;
  std::array<std::vector<Real>, 3> diagonal_first_;  // diagonal of K_a
  std::array<std::vector<Real>, 3> diagonal_second_; // diagonal of the second differences' Gram matrix along a
};

extern template class HessianOperator<float>;
extern template class HessianOperator<double>;

} // namespace pcl::cosection
