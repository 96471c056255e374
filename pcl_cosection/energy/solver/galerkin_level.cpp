// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "galerkin_level.h"

#include "chebyshev.h"

namespace pcl::cosection {
namespace {

constexpr std::size_t work_per_voxel = 8; // of a pass, relative to one on the finest level

template <typename Real>
void
fill (const Pentadiagonal& matrix, int i, double factor, Real (&row)[5])
{
  for (int d = 0; d < 5; ++d)
    row[d] = static_cast<Real> (factor * matrix[d][i]);
}

} // namespace

template <typename Real>
GalerkinLevel<Real>::GalerkinLevel (const std::array<GalerkinAxis, 3>& axes, double alpha, int threads)
    : dims_ (axes[0].size, axes[1].size, axes[2].size)
    , threads_ (threadsForVoxels (threads, work_per_voxel * size ()))
{
  const std::array<const Pentadiagonal*, 3> along_x{&axes[0].mass, &axes[0].first, &axes[0].second};
  for (int field = 0; field < 3; ++field)
    for (int d = 0; d < 5; ++d)
      x_coefficients_[5 * field + d].assign ((*along_x[field])[d].begin (), (*along_x[field])[d].end ());
  for (int axis = 1; axis < 3; ++axis)
  {
    auto& rows = coefficients_[axis - 1];
    rows.resize (dims_[axis]);
    for (int i = 0; i < dims_[axis]; ++i)
    {
      const double factor = axis == 2 ? alpha : 1.0;
      fill (axes[axis].mass, i, factor, rows[i].mass);
      fill (axes[axis].first, i, factor, rows[i].first);
      fill (axes[axis].second, i, factor, rows[i].second);
    }
  }
  diagonal_.resize (size ());
  std::size_t n = 0;
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
        diagonal_[n++] = static_cast<Real> (
            alpha * (k2[0] * m[1] * m[2] + m[0] * k2[1] * m[2] + m[0] * m[1] * k2[2] +
                     2.0 * (k1[0] * k1[1] * m[2] + k1[0] * m[1] * k1[2] + m[0] * k1[1] * k1[2])));
      }
}

template <typename Real>
double
GalerkinLevel<Real>::estimateLargestEigenvalue () const
{
  constexpr int iterations = 30;
  GuardedField<Real> v (size ());
  std::vector<Real> next (size ());
  for (std::size_t n = 0; n < v.size (); ++n) // a rough start vector, always the same
    v[n] = static_cast<Real> ((n * 2654435761u >> 16) % 1024) - Real (511.5);
  double eigenvalue = 0.0;
  for (int i = 0; i < iterations; ++i)
  {
    forEachRow (v.data (), [&] (int j, int k, const Real* product) {
      const std::size_t offset = (static_cast<std::size_t> (k) * dims_.y () + j) * dims_.x ();
      for (int x = 0; x < dims_.x (); ++x)
        next[offset + x] = product[x] / diagonal_[offset + x];
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

template <typename Real>
void
GalerkinLevel<Real>::updateDiagonal ()
{
  inverse_diagonal_.resize (size ());
  parallelFor (0, dims_.z (), threads_, [&] (int k) {
    std::vector<Real> sums (dims_.x ());
    for (int j = 0; j < dims_.y (); ++j)
    {
      std::fill (sums.begin (), sums.end (), Real (0));
      weights.addAbsoluteRowSums (j, k, sums.data ());
      const std::size_t offset = (static_cast<std::size_t> (k) * dims_.y () + j) * dims_.x ();
      for (int i = 0; i < dims_.x (); ++i)
        inverse_diagonal_[offset + i] = Real (1) / (diagonal_[offset + i] + sums[i]);
    }
  });
}

template <typename Real>
void
GalerkinLevel<Real>::smooth (const Real* rhs, Real* z, Real* d, int degree, bool from_zero) const
{
  const ChebyshevSteps steps (degree, largest_eigenvalue_);
  const std::size_t plane = static_cast<std::size_t> (dims_.x ()) * dims_.y ();
  for (int s = 0; s < degree; ++s)
  {
    const Real momentum = s == 0 ? Real (0) : static_cast<Real> (steps.momentum (s));
    const Real step = static_cast<Real> (steps.step (s));
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
    forEachRow (z, [&] (int j, int k, const Real* product) {
      const std::size_t offset = (static_cast<std::size_t> (k) * dims_.y () + j) * dims_.x ();
      kernels::chebyshevStepRow (rhs + offset, product, inverse_diagonal_.data () + offset, momentum, step, dims_.x (),
                                 d + offset);
    });
    parallelFor (0, dims_.z (), threads_,
                 [&] (int k) { kernels::addRow (d + k * plane, static_cast<int> (plane), z + k * plane); });
  }
}

template class GalerkinLevel<float>;
template class GalerkinLevel<double>;

} // namespace pcl::cosection
