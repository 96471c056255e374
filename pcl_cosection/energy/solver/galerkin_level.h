// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "galerkin_axis.h"
#include "galerkin_weights.h"
#include "row_kernels.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace pcl::cosection {

/** \brief The operator alpha P^T (H^T H) P + P^T diag (w) P of one coarse level, exact, and its
 * smoother. */
template <typename Real> class GalerkinLevel
{
public:
  GalerkinLevel (const std::array<GalerkinAxis, 3>& axes, double alpha, int threads);

  /** \brief Largest eigenvalue of D^-1 times the regulariser, which smooth () needs; by power iteration. */
  double estimateLargestEigenvalue () const;

  void setLargestEigenvalue (double value) { largest_eigenvalue_ = value; }

  /** \brief P^T diag (w) P; after changing it call updateDiagonal (). */
  GalerkinWeights<Real> weights;

  /** \brief Recompute the smoother's diagonal D: the regulariser's diagonal plus the absolute row sums of
   * P^T diag (w) P, so that D^-1 times that part has no eigenvalue above one. */
  void updateDiagonal ();

  /** \brief Call \a row (j, k, values) with every row of the operator times \a v, the values of a
   * GuardedField. */
  template <typename RowFunction> void forEachRow (const Real* v, RowFunction&& row) const;

  /** \brief Improve z for operator * z = rhs by Chebyshev iterations of the fourth kind.
   * \param[in,out] z the values of a GuardedField
   * \param[in] from_zero take z as zero on entry, whatever it holds
   * \param d scratch, one value per voxel */
  void smooth (const Real* rhs, Real* z, Real* d, int degree, bool from_zero) const;

  int threads () const { return threads_; }

  const Eigen::Vector3i& dims () const { return dims_; }

  std::size_t size () const { return static_cast<std::size_t> (dims_.x ()) * dims_.y () * dims_.z (); }

private:
  Eigen::Vector3i dims_;
  int threads_;
  double largest_eigenvalue_ = 0.0;                                          // of D^-1 times the operator
  std::array<std::vector<Real>, 15> x_coefficients_;                         // [5 * (mass, first, second) + offset][x]
  std::array<std::vector<kernels::AxisCoefficients<Real>>, 2> coefficients_; // by y, and by z times alpha
  std::vector<Real> diagonal_;                                               // of the regulariser
  std::vector<Real> inverse_diagonal_;
};

template <typename Real>
template <typename RowFunction>
void
GalerkinLevel<Real>::forEachRow (const Real* v, RowFunction&& row) const
{
  const int nx = dims_.x ();
  const int ny = dims_.y ();
  const int nz = dims_.z ();
  const std::size_t plane = static_cast<std::size_t> (nx) * ny;

  parallelChunks (0, nz, threads_, [&] (int first, int last) {
    std::vector<Real> ring (5 * 3 * plane); // mass, first and second of five planes, contracted along x and y
    std::vector<Real> along_x (3 * plane);
    std::vector<Real> padded (nx + 4, Real (0));
    std::vector<Real> out (nx + GuardedField<Real>::guard);
    const auto slot = [&] (int k, int field) { return ring.data () + ((k + 5) % 5 * 3 + field) * plane; };
    const auto contractPlane = [&] (int k) {
      for (int j = 0; j < ny; ++j)
      {
        std::copy_n (v + k * plane + static_cast<std::size_t> (j) * nx, nx, padded.data () + 2);
        for (int field = 0; field < 3; ++field)
        {
          std::array<const Real*, 5> c;
          for (int d = 0; d < 5; ++d)
            c[d] = x_coefficients_[5 * field + d].data ();
          kernels::pentadiagonalRow (padded.data () + 2, c.data (), nx,
                                     along_x.data () + field * plane + static_cast<std::size_t> (j) * nx);
        }
      }
      for (int j = 0; j < ny; ++j)
      {
        std::array<std::array<const Real*, 5>, 3> rows;
        for (int field = 0; field < 3; ++field)
          for (int d = 0; d < 5; ++d) // coefficients beyond the border are 0
            rows[field][d] = along_x.data () + field * plane +
                             static_cast<std::size_t> (std::clamp (j + d - 2, 0, ny - 1)) * nx;
        const std::size_t offset = static_cast<std::size_t> (j) * nx;
        kernels::contractRows (rows[0].data (), rows[1].data (), rows[2].data (), coefficients_[0][j], nx,
                               slot (k, 0) + offset, slot (k, 1) + offset, slot (k, 2) + offset);
      }
    };
    for (int k = std::max (0, first - 2); k < std::min (nz, first + 2); ++k)
      contractPlane (k);
    for (int k = first; k < last; ++k)
    {
      if (k + 2 < nz)
        contractPlane (k + 2);
      for (int j = 0; j < ny; ++j)
      {
        std::array<std::array<const Real*, 5>, 3> rows;
        for (int field = 0; field < 3; ++field)
          for (int d = 0; d < 5; ++d)
            rows[field][d] = slot (std::clamp (k + d - 2, 0, nz - 1), field) + static_cast<std::size_t> (j) * nx;
        kernels::contractPlanes (rows[0].data (), rows[1].data (), rows[2].data (), coefficients_[1][k], nx,
                                 out.data ());
        weights.addRowProduct (v, j, k, out.data ());
        row (j, k, const_cast<const Real*> (out.data ()));
      }
    }
  });
}

} // namespace pcl::cosection
