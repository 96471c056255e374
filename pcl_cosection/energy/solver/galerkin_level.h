// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "galerkin_weights.h"
#include "grid_transfer.h"
#include "pcl_cosection/common/parallel.h"
#include "row_kernels.h"

#include <algorithm>
#include <array>
#include <vector>

namespace pcl::cosection {

/** \brief Coefficients of a Chebyshev iteration of the fourth kind, which needs only the largest
 * eigenvalue of D^-1 A (J. Lottes, "Optimal polynomial smoothers for multigrid V-cycles", Numerical
 * Linear Algebra with Applications 2023): d <- momentum d + step D^-1 (b - A z), z <- z + d. */
struct ChebyshevSteps
{
  /** \brief Safety factor for an estimated largest eigenvalue. */
  static constexpr double safety = 1.08;

  double largest_eigenvalue;

  double momentum (int s) const { return s == 0 ? 0.0 : (2.0 * s - 1.0) / (2.0 * s + 3.0); }

  double step (int s) const { return (8.0 * s + 4.0) / (2.0 * s + 3.0) * (1.0 / largest_eigenvalue); }
};

/** \brief A symmetric matrix of half bandwidth two along one axis: entry [d][i] couples i and
 * i + d - 2; entries that would reach over the border are 0. */
using Pentadiagonal = std::array<std::vector<double>, 5>;

/** \brief The one-dimensional factors of the Hessian's Gram matrix along one axis of one level.
 *
 *     H^T H = K2 x M x M + M x K2 x M + M x M x K2 + 2 (K1 x K1 x M + K1 x M x K1 + M x K1 x K1)
 *
 * with M = identity, K1 = first and K2 = second differences' Gram matrix on the finest level. For a
 * tensor-product interpolation the Galerkin product P^T (H^T H) P keeps that form with P^T M P,
 * P^T K1 P and P^T K2 P, which all stay pentadiagonal: the exact coarse operator costs three banded
 * matrices an axis, and no stored stencil. */
struct GalerkinAxis
{
  int size = 0;
  Pentadiagonal mass, first, second;

  /** \brief The factors of an axis of \a size voxels on the finest level. */
  static GalerkinAxis finest (int size)
  {
    GalerkinAxis axis;
    axis.size = size;
    axis.mass.fill (std::vector<double> (size, 0.0));
    axis.first = axis.second = axis.mass;
    axis.mass[2].assign (size, 1.0);
    for (int i = 0; i + 1 < size; ++i)
    {
      axis.first[2][i] += 1.0;
      axis.first[2][i + 1] += 1.0;
      axis.first[3][i] -= 1.0;
      axis.first[1][i + 1] -= 1.0;
    }
    constexpr std::array<double, 3> difference{1.0, -2.0, 1.0};
    for (int i = 1; i + 1 < size; ++i)
      for (int s = -1; s <= 1; ++s)
        for (int t = -1; t <= 1; ++t)
          axis.second[t - s + 2][i + s] += difference[s + 1] * difference[t + 1];
    return axis;
  }

  /** \brief The factors on the next coarser level. */
  GalerkinAxis coarsen (const AxisTransfer& transfer) const
  {
    if (transfer.coarse_size == transfer.fine_size)
      return *this;
    const auto galerkin = [&] (const Pentadiagonal& fine) {
      Pentadiagonal coarse;
      coarse.fill (std::vector<double> (transfer.coarse_size, 0.0));
      for (int x = 0; x < size; ++x)
        for (int y = std::max (0, x - 2); y < std::min (size, x + 3); ++y)
          for (const auto& p : transfer.parents[x])
            for (const auto& q : transfer.parents[y])
              if (p.weight != 0.0 && q.weight != 0.0)
                coarse[q.voxel - p.voxel + 2][p.voxel] += p.weight * q.weight * fine[y - x + 2][x];
      return coarse;
    };
    return {transfer.coarse_size, galerkin (mass), galerkin (first), galerkin (second)};
  }

  /** \brief An axis of at most \a keep voxels with the same rows near its borders; rows in the middle, which are all
   * alike, are removed. For local quantities. */
  GalerkinAxis shortened (int keep) const
  {
    if (size <= keep)
      return *this;
    GalerkinAxis axis = *this;
    axis.size = keep;
    for (Pentadiagonal* matrix : {&axis.mass, &axis.first, &axis.second})
      for (std::vector<double>& diagonal : *matrix)
        diagonal.erase (diagonal.begin () + keep / 2, diagonal.end () - (keep - keep / 2));
    return axis;
  }
};

/** \brief The operator alpha P^T (H^T H) P + P^T diag (w) P of one coarse level, exact, and its
 * smoother. */
template <typename Real> class GalerkinLevel
{
public:
  GalerkinLevel (const std::array<GalerkinAxis, 3>& axes, double alpha, int threads)
      : dims_ (axes[0].size, axes[1].size, axes[2].size)
      , threads_ (threadsForVoxels (threads, work_per_voxel * size ()))
  {
    const std::array<const Pentadiagonal*, 3> along_x{&axes[0].mass, &axes[0].first, &axes[0].second};
    for (int field = 0; field < 3; ++field)
      for (int d = 0; d < 5; ++d)
        x_coefficients_[5 * field + d].assign ((*along_x[field])[d].begin (), (*along_x[field])[d].end ());
    for (int axis = 1; axis < 3; ++axis)
    {
      const double factor = axis == 2 ? alpha : 1.0;
      coefficients_[axis - 1].resize (dims_[axis]);
      for (int i = 0; i < dims_[axis]; ++i)
        for (int d = 0; d < 5; ++d)
        {
          coefficients_[axis - 1][i].mass[d] = static_cast<Real> (factor * axes[axis].mass[d][i]);
          coefficients_[axis - 1][i].first[d] = static_cast<Real> (factor * axes[axis].first[d][i]);
          coefficients_[axis - 1][i].second[d] = static_cast<Real> (factor * axes[axis].second[d][i]);
        }
    }
    diagonal_.reserve (size ());
    for (int k = 0; k < dims_.z (); ++k)
      for (int j = 0; j < dims_.y (); ++j)
        for (int i = 0; i < dims_.x (); ++i)
        {
          const std::array<int, 3> at{i, j, k};
          std::array<double, 3> m{}, k1{}, k2{};
          for (int a = 0; a < 3; ++a)
          {
            m[a] = axes[a].mass[2][at[a]];
            k1[a] = axes[a].first[2][at[a]];
            k2[a] = axes[a].second[2][at[a]];
          }
          diagonal_.push_back (
              static_cast<Real> (alpha * (k2[0] * m[1] * m[2] + m[0] * k2[1] * m[2] + m[0] * m[1] * k2[2] +
                                          2.0 * (k1[0] * k1[1] * m[2] + k1[0] * m[1] * k1[2] + m[0] * k1[1] * k1[2]))));
        }
  }

  /** \brief Largest eigenvalue of D^-1 times the regulariser, which smooth () needs; by power iteration. */
  double estimateLargestEigenvalue () const
  {
    constexpr int iterations = 30;
    GuardedField<Real> v (size ());
    std::vector<Real> next (size ());
    for (std::size_t n = 0; n < v.size (); ++n) // a rough start vector, always the same
      v[n] = static_cast<Real> ((n * 2654435761u >> 16) % 1024) - Real (511.5);
    double eigenvalue = 0.0;
    for (int i = 0; i < iterations; ++i)
    {
      forEachRow (v.data (), [&] (std::size_t at, const Real* product) {
        for (int x = 0; x < dims_.x (); ++x)
          next[at + x] = product[x] / diagonal_[at + x];
      });
      double norm = 0.0;
      double dot = 0.0;
      for (std::size_t n = 0; n < v.size (); ++n)
      {
        norm += static_cast<double> (diagonal_[n]) * v[n] * v[n];
        dot += static_cast<double> (diagonal_[n]) * v[n] * next[n];
      }
      eigenvalue = dot / norm; // Rayleigh quotient
      const Real scale = static_cast<Real> (1.0 / eigenvalue);
      for (std::size_t n = 0; n < v.size (); ++n)
        v[n] = scale * next[n];
    }
    return eigenvalue;
  }

  void setLargestEigenvalue (double value) { steps_.largest_eigenvalue = value; }

  /** \brief P^T diag (w) P; after changing it call updateDiagonal (). */
  GalerkinWeights<Real> weights;

  /** \brief Recompute the smoother's diagonal D: the regulariser's diagonal plus the absolute row sums of
   * P^T diag (w) P, so that D^-1 times that part has no eigenvalue above one. */
  void updateDiagonal ()
  {
    inverse_diagonal_.resize (size ());
    parallelFor (0, dims_.z (), threads_, [&] (int k) {
      std::vector<Real> sums (dims_.x ());
      for (int j = 0; j < dims_.y (); ++j)
      {
        std::fill (sums.begin (), sums.end (), Real (0));
        weights.addAbsoluteRowSums (j, k, sums.data ());
        const std::size_t at = (static_cast<std::size_t> (k) * dims_.y () + j) * dims_.x ();
        for (int i = 0; i < dims_.x (); ++i)
          inverse_diagonal_[at + i] = Real (1) / (diagonal_[at + i] + sums[i]);
      }
    });
  }

  /** \brief Call \a row (index of the first voxel, values) with every row of the operator times \a v, the values of a
   * GuardedField. */
  template <typename RowFunction> void forEachRow (const Real* v, RowFunction&& row) const
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
      std::array<std::array<const Real*, 5>, 3> rows;
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
          const std::size_t offset = static_cast<std::size_t> (j) * nx;
          for (int field = 0; field < 3; ++field)
            for (int d = 0; d < 5; ++d)
              rows[field][d] = slot (std::clamp (k + d - 2, 0, nz - 1), field) + offset;
          kernels::contractPlanes (rows[0].data (), rows[1].data (), rows[2].data (), coefficients_[1][k], nx,
                                   out.data ());
          weights.addRowProduct (v, j, k, out.data ());
          row (k * plane + offset, const_cast<const Real*> (out.data ()));
        }
      }
    });
  }

  /** \brief Improve z for operator * z = rhs by Chebyshev iterations of the fourth kind.
   * \param[in,out] z the values of a GuardedField
   * \param[in] from_zero take z as zero on entry, whatever it holds
   * \param d scratch, one value per voxel */
  void smooth (const Real* rhs, Real* z, Real* d, int degree, bool from_zero) const
  {
    const std::size_t plane = static_cast<std::size_t> (dims_.x ()) * dims_.y ();
    for (int s = 0; s < degree; ++s)
    {
      const Real momentum = static_cast<Real> (steps_.momentum (s));
      const Real step = static_cast<Real> (steps_.step (s));
      if (s == 0 && from_zero)
      {
        parallelFor (0, dims_.z (), threads_, [&] (int k) {
          for (std::size_t i = k * plane; i < (k + 1) * plane; ++i)
            z[i] = d[i] = step * inverse_diagonal_[i] * rhs[i];
        });
        continue;
      }
      if (s == 0)
        std::fill_n (d, size (), Real (0)); // it may hold NaN
      forEachRow (z, [&] (std::size_t at, const Real* product) {
        kernels::chebyshevStepRow (rhs + at, product, inverse_diagonal_.data () + at, momentum, step, dims_.x (),
                                   d + at);
      });
      parallelFor (0, dims_.z (), threads_,
                   [&] (int k) { kernels::addRow (d + k * plane, static_cast<int> (plane), z + k * plane); });
    }
  }

  int threads () const { return threads_; }

  const Eigen::Vector3i& dims () const { return dims_; }

  std::size_t size () const { return static_cast<std::size_t> (dims_.x ()) * dims_.y () * dims_.z (); }

private:
  static constexpr std::size_t work_per_voxel = 8; // of a pass, relative to one on the finest level

  Eigen::Vector3i dims_;
  int threads_;
  ChebyshevSteps steps_{0.0};                        // largest eigenvalue of D^-1 times the operator
  std::array<std::vector<Real>, 15> x_coefficients_; // [5 * (mass, first, second) + offset][x]
  std::array<std::vector<kernels::AxisCoefficients<Real>>, 2> coefficients_; // by y, and by z times alpha
  std::vector<Real> diagonal_;                                               // of the regulariser
  std::vector<Real> inverse_diagonal_;
};

} // namespace pcl::cosection
