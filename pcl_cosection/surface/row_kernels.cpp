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

// Sums run in this many independent lanes, so that the compiler may vectorise them and the result does
// not depend on how it does.
constexpr int lanes = 8;

template <typename Body> PCL_COSECTION_INLINE void
forLanes (int n, Body&& body)
{
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l)
      body (i + l, l);
  for (; i < n; ++i)
    body (i, i % lanes);
}

template <typename Real> PCL_COSECTION_INLINE double
total (const Real (&sums)[lanes])
{
  double sum = 0.0;
  for (const Real s : sums)
    sum += static_cast<double> (s);
  return sum;
}

template <typename Real, bool has_exterior, bool has_intersection, bool outputs> PCL_COSECTION_INLINE double
evaluateTerms (const EnergyRow& row, const Real* __restrict h, const Real* __restrict u, Real alpha, int n,
               Real* __restrict residual, std::uint16_t* __restrict packed)
{
  Real sums[lanes] = {};
  forLanes (n, [&] (int i, int l) {
    const Real value = u[i];
    float weight = row.weight[i];
    const Real target = row.weighted_target[i];
    const Real smooth = alpha * h[i] + static_cast<Real> (weight) * value;
    Real sum = value * (smooth - 2 * target);
    Real r = target - smooth;
    const auto addBound = [&] (const LowerBound& bound) {
      const Real violation = static_cast<Real> (bound.distance ()) - value;
      const float beta = violation > Real (0) ? bound.weight () : 0.0f;
      weight += beta;
      const Real pull = static_cast<Real> (beta) * violation;
      r += pull;
      sum += pull * violation;
    };
    if (has_exterior)
      addBound (row.exterior[i]);
    if (has_intersection)
      addBound (row.intersection[i]);
    if (outputs)
    {
      residual[i] = r;
      packed[i] = packWeight (weight);
    }
    sums[l] += sum;
  });
  return total (sums);
}

template <typename Real, bool outputs> PCL_COSECTION_INLINE double
evaluateBounds (const EnergyRow& row, const Real* h, const Real* u, Real alpha, int n, Real* residual, std::uint16_t* packed)
{
  if (row.exterior && row.intersection)
    return evaluateTerms<Real, true, true, outputs> (row, h, u, alpha, n, residual, packed);
  if (row.exterior)
    return evaluateTerms<Real, true, false, outputs> (row, h, u, alpha, n, residual, packed);
  if (row.intersection)
    return evaluateTerms<Real, false, true, outputs> (row, h, u, alpha, n, residual, packed);
  return evaluateTerms<Real, false, false, outputs> (row, h, u, alpha, n, residual, packed);
}

template <typename Real> PCL_COSECTION_INLINE void
boundDerivatives (const LowerBound* __restrict bounds, const Real* __restrict u, const Real* __restrict p, Real t, int n,
                  double& slope, double& curvature)
{
  constexpr int block = 512; // short enough for sums in Real
  for (int first = 0; first < n; first += block)
  {
    Real slopes[lanes] = {};
    Real curvatures[lanes] = {};
    const LowerBound* __restrict b = bounds + first;
    const Real* __restrict at = u + first;
    const Real* __restrict along = p + first;
    forLanes (n - first < block ? n - first : block, [&] (int i, int l) {
      const Real violation = static_cast<Real> (b[i].distance ()) - at[i] - t * along[i];
      const Real pull = (violation > Real (0) ? static_cast<Real> (b[i].weight ()) : Real (0)) * along[i];
      slopes[l] -= pull * violation;
      curvatures[l] += pull * along[i];
    });
    slope += total (slopes);
    curvature += total (curvatures);
  }
}

template <typename Real> PCL_COSECTION_INLINE DirectionProducts
directionProducts (const float* __restrict weight, const std::uint16_t* __restrict packed, const Real* __restrict residual,
                   const Real* __restrict h, const Real* __restrict z, const Real* __restrict p, Real alpha, int n)
{
  Real sums[7][lanes] = {};
  forLanes (n, [&] (int i, int l) {
    const Real product = alpha * h[i] + static_cast<Real> (weight[i]) * z[i];
    const Real active = static_cast<Real> (unpackWeight (packed[i]) - weight[i]);
    sums[0][l] += product * z[i];
    sums[1][l] += product * p[i];
    sums[2][l] += active * z[i] * z[i];
    sums[3][l] += active * z[i] * p[i];
    sums[4][l] += active * p[i] * p[i];
    sums[5][l] += residual[i] * z[i];
    sums[6][l] += residual[i] * p[i];
  });
  return {total (sums[0]), total (sums[1]), total (sums[2]), total (sums[3]), total (sums[4]), total (sums[5]), total (sums[6])};
}

template <typename Real> PCL_COSECTION_INLINE Real
advance (const Real* __restrict p, Real t, Real band, int n, Real* __restrict u)
{
  Real largest[lanes] = {};
  forLanes (n, [&] (int i, int l) {
    const Real before = u[i];
    const Real change = t * p[i];
    const Real after = before + change;
    u[i] = after;
    const Real size = change < Real (0) ? -change : change;
    const bool near = (before < band && before > -band) || (after < band && after > -band);
    const Real counted = near ? size : Real (0);
    largest[l] = counted > largest[l] ? counted : largest[l];
  });
  Real all = 0;
  for (const Real value : largest)
    all = value > all ? value : all;
  return all;
}

} // namespace

void
DirectionProducts::operator+= (const DirectionProducts& other)
{
  z_S_z += other.z_S_z;
  z_S_p += other.z_S_p;
  z_A_z += other.z_A_z;
  z_A_p += other.z_A_p;
  p_A_p += other.p_A_p;
  r_z += other.r_z;
  r_p += other.r_p;
}

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
  PCL_COSECTION_MULTIVERSION double evaluateRow (const EnergyRow& row, const Real* h, const Real* u, Real alpha,     \
    int n, Real* residual, std::uint16_t* packed)                                                                    \
  { return residual ? evaluateBounds<Real, true> (row, h, u, alpha, n, residual, packed)                             \
                    : evaluateBounds<Real, false> (row, h, u, alpha, n, residual, packed); }                         \
  PCL_COSECTION_MULTIVERSION void boundsRow (const LowerBound* bounds, const Real* u, const Real* p, Real t, int n,  \
    double& slope, double& curvature)                                                                                \
  { boundDerivatives<Real> (bounds, u, p, t, n, slope, curvature); }                                                 \
  PCL_COSECTION_MULTIVERSION DirectionProducts directionRow (const float* weight, const std::uint16_t* packed,       \
    const Real* residual, const Real* h, const Real* z, const Real* p, Real alpha, int n)                            \
  { return directionProducts<Real> (weight, packed, residual, h, z, p, alpha, n); }                                  \
  PCL_COSECTION_MULTIVERSION Real advanceRow (const Real* p, Real t, Real band, int n, Real* u)                      \
  { return advance<Real> (p, t, band, n, u); }                                                                       \
  PCL_COSECTION_MULTIVERSION void pentadiagonalRow (const Real* in, const Real* const* coefficients, int n, Real* out)\
  { pentadiagonal<Real> (in, coefficients, n, out); }
// clang-format on

PCL_COSECTION_ROW_KERNELS (float)
PCL_COSECTION_ROW_KERNELS (double)

} // namespace kernels
} // namespace cosection
} // namespace pcl
