// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "row_kernels.h"

#include "../common/multiversion.h"

namespace pcl
{
namespace cosection
{
namespace kernels
{

namespace
{

template <typename Real> PCL_COSECTION_INLINE void
laplace (const RowNeighbours<Real>& u, int n, Real* __restrict out)
{
  const Real* c = u.center;
  const Real* ym = u.y_minus;
  const Real* yp = u.y_plus;
  const Real* zm = u.z_minus;
  const Real* zp = u.z_plus;
  const auto across = [=] (int i) { return (c[i] - ym[i]) + (c[i] - yp[i]) + ((c[i] - zm[i]) + (c[i] - zp[i])); };
  if (n == 1)
  {
    out[0] = across (0);
    return;
  }
  out[0] = across (0) + (c[0] - c[1]);
  for (int i = 1; i < n - 1; ++i)
    out[i] = ((c[i] - ym[i]) + (c[i] - yp[i])) + ((c[i] - zm[i]) + (c[i] - zp[i])) + ((c[i] - c[i - 1]) + (c[i] - c[i + 1]));
  out[n - 1] = across (n - 1) + (c[n - 1] - c[n - 2]);
}

template <typename Real> PCL_COSECTION_INLINE void
chebyshev (const Real* __restrict rhs, const Real* __restrict h, const std::uint16_t* __restrict w, const Real* __restrict z,
           const HessianDiagonal<Real>& diagonal, Real alpha, Real momentum, Real step, int n, Real* __restrict d)
{
  const Real* __restrict first = diagonal.first;
  const Real* __restrict second = diagonal.second;
  const Real slope = diagonal.slope;
  const Real constant = diagonal.constant;
  for (int i = 0; i < n; ++i)
  {
    const Real wi = unpackWeight (w[i]);
    d[i] = momentum * d[i] + step * (rhs[i] - alpha * h[i] - wi * z[i]) / (alpha * (second[i] + slope * first[i] + constant) + wi);
  }
}

template <typename Real> PCL_COSECTION_INLINE void
residual (const Real* __restrict rhs, const Real* __restrict h, const std::uint16_t* __restrict w,
          const Real* __restrict z, Real alpha, int n, Real* __restrict out)
{
  for (int i = 0; i < n; ++i)
    out[i] = rhs[i] - alpha * h[i] - static_cast<Real> (unpackWeight (w[i])) * z[i];
}

template <typename Real> PCL_COSECTION_INLINE void
pentadiagonal (const Real* __restrict in, const Real* const* coefficients, int n, Real* __restrict out)
{
  const Real* __restrict c0 = coefficients[0];
  const Real* __restrict c1 = coefficients[1];
  const Real* __restrict c2 = coefficients[2];
  const Real* __restrict c3 = coefficients[3];
  const Real* __restrict c4 = coefficients[4];
  for (int i = 0; i < n; ++i)
    out[i] = c0[i] * in[i - 2] + c1[i] * in[i - 1] + c2[i] * in[i] + c3[i] * in[i + 1] + c4[i] * in[i + 2];
}

template <typename Real> PCL_COSECTION_INLINE void
symmetric (const Real* __restrict v, const Real* __restrict diagonal, const Real* __restrict first,
           const Real* __restrict second, int n, Real* __restrict out)
{
  if (n >= 3 && first && !second)
  {
    out[0] += diagonal[0] * v[0] + first[0] * v[1];
    for (int i = 1; i < n - 1; ++i)
      out[i] += first[i - 1] * v[i - 1] + diagonal[i] * v[i] + first[i] * v[i + 1];
    out[n - 1] += first[n - 2] * v[n - 2] + diagonal[n - 1] * v[n - 1];
    return;
  }
  if (n < 5 || !first || !second)
  {
    for (int i = 0; i < n; ++i)
      out[i] += diagonal[i] * v[i];
    for (int i = 0; first && i + 1 < n; ++i)
      out[i] += first[i] * v[i + 1];
    for (int i = 1; first && i < n; ++i)
      out[i] += first[i - 1] * v[i - 1];
    for (int i = 0; second && i + 2 < n; ++i)
      out[i] += second[i] * v[i + 2];
    for (int i = 2; second && i < n; ++i)
      out[i] += second[i - 2] * v[i - 2];
    return;
  }
  out[0] += diagonal[0] * v[0] + first[0] * v[1] + second[0] * v[2];
  out[1] += first[0] * v[0] + diagonal[1] * v[1] + first[1] * v[2] + second[1] * v[3];
  for (int i = 2; i < n - 2; ++i)
    out[i] += second[i - 2] * v[i - 2] + first[i - 1] * v[i - 1] + diagonal[i] * v[i] + first[i] * v[i + 1] +
              second[i] * v[i + 2];
  out[n - 2] += second[n - 4] * v[n - 4] + first[n - 3] * v[n - 3] + diagonal[n - 2] * v[n - 2] + first[n - 2] * v[n - 1];
  out[n - 1] += second[n - 3] * v[n - 3] + first[n - 2] * v[n - 2] + diagonal[n - 1] * v[n - 1];
}

template <typename Real> PCL_COSECTION_INLINE void
contractY (const Real* const* m, const Real* const* f, const Real* const* s, const AxisCoefficients<Real>& c, int n,
           Real* __restrict out_mass, Real* __restrict out_first, Real* __restrict out_second)
{
  for (int i = 0; i < n; ++i)
  {
    Real mm = 0, mf = 0, fm = 0, ms = 0, sm = 0, ff = 0;
    for (int d = 0; d < 5; ++d)
    {
      const Real mi = m[d][i];
      const Real fi = f[d][i];
      mm += c.mass[d] * mi;
      fm += c.first[d] * mi;
      sm += c.second[d] * mi;
      mf += c.mass[d] * fi;
      ff += c.first[d] * fi;
      ms += c.mass[d] * s[d][i];
    }
    out_mass[i] = mm;
    out_first[i] = 2 * (mf + fm);
    out_second[i] = ms + sm + 2 * ff;
  }
}

template <typename Real> PCL_COSECTION_INLINE void
contractZ (const Real* const* m, const Real* const* f, const Real* const* s, const AxisCoefficients<Real>& c, int n,
           Real* __restrict out)
{
  for (int i = 0; i < n; ++i)
  {
    Real sum = 0;
    for (int d = 0; d < 5; ++d)
      sum += c.mass[d] * s[d][i] + c.first[d] * f[d][i] + c.second[d] * m[d][i];
    out[i] = sum;
  }
}

} // namespace

// clang-format off
#define PCL_COSECTION_ROW_KERNELS(Real)                                                                              \
  PCL_COSECTION_MULTIVERSION void laplaceRow (const RowNeighbours<Real>& u, int n, Real* out)                        \
  { laplace<Real> (u, n, out); }                                                                                     \
  PCL_COSECTION_MULTIVERSION void subtractDifference (const Real* a, const Real* b, int n, Real* out)                \
  { for (int i = 0; i < n; ++i) out[i] -= a[i] - b[i]; }                                                             \
  PCL_COSECTION_MULTIVERSION void chebyshevRow (const Real* rhs, const Real* h, const std::uint16_t* w,              \
    const Real* z, const HessianDiagonal<Real>& diagonal, Real alpha, Real momentum, Real step, int n, Real* d)      \
  { chebyshev<Real> (rhs, h, w, z, diagonal, alpha, momentum, step, n, d); }                                         \
  PCL_COSECTION_MULTIVERSION void residualRow (const Real* rhs, const Real* h, const std::uint16_t* w, const Real* z,\
    Real alpha, int n, Real* out)                                                                                    \
  { residual<Real> (rhs, h, w, z, alpha, n, out); }                                                                  \
  PCL_COSECTION_MULTIVERSION void addRow (const Real* __restrict a, int n, Real* __restrict out)                     \
  { for (int i = 0; i < n; ++i) out[i] += a[i]; }                                                                    \
  PCL_COSECTION_MULTIVERSION void addScaledRow (const Real* __restrict a, Real factor, int n, Real* __restrict out)  \
  { for (int i = 0; i < n; ++i) out[i] += factor * a[i]; }                                                           \
  PCL_COSECTION_MULTIVERSION void scaleAddRow (const Real* __restrict a, Real factor, int n, Real* __restrict out)   \
  { for (int i = 0; i < n; ++i) out[i] = a[i] + factor * out[i]; }                                                   \
  PCL_COSECTION_MULTIVERSION void symmetricRow (const Real* v, const Real* diagonal, const Real* first,              \
    const Real* second, int n, Real* out)                                                                            \
  { symmetric<Real> (v, diagonal, first, second, n, out); }                                                          \
  PCL_COSECTION_MULTIVERSION void contractRows (const Real* const* mass, const Real* const* first,                   \
    const Real* const* second, const AxisCoefficients<Real>& c, int n, Real* out_mass, Real* out_first, Real* out_second)\
  { contractY<Real> (mass, first, second, c, n, out_mass, out_first, out_second); }                                  \
  PCL_COSECTION_MULTIVERSION void contractPlanes (const Real* const* mass, const Real* const* first,                 \
    const Real* const* second, const AxisCoefficients<Real>& c, int n, Real* out)                                    \
  { contractZ<Real> (mass, first, second, c, n, out); }                                                              \
  PCL_COSECTION_MULTIVERSION void chebyshevStepRow (const Real* __restrict rhs, const Real* __restrict product,      \
    const Real* __restrict inverse_diagonal, Real momentum, Real step, int n, Real* __restrict d)                    \
  { for (int i = 0; i < n; ++i) d[i] = momentum * d[i] + step * inverse_diagonal[i] * (rhs[i] - product[i]); }       \
  PCL_COSECTION_MULTIVERSION void pentadiagonalRow (const Real* in, const Real* const* coefficients, int n, Real* out)\
  { pentadiagonal<Real> (in, coefficients, n, out); }
// clang-format on

PCL_COSECTION_ROW_KERNELS (float)
PCL_COSECTION_ROW_KERNELS (double)

} // namespace kernels
} // namespace cosection
} // namespace pcl
