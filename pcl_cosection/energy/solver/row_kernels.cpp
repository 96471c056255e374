// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "row_kernels.h"

#include "pcl_cosection/common/multiversion.h"

namespace pcl::cosection::kernels {
namespace {

template <typename Real>
PCL_COSECTION_INLINE void
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
    out[i] = ((c[i] - ym[i]) + (c[i] - yp[i])) + ((c[i] - zm[i]) + (c[i] - zp[i])) +
             ((c[i] - c[i - 1]) + (c[i] - c[i + 1]));
  out[n - 1] = across (n - 1) + (c[n - 1] - c[n - 2]);
}

template <typename Real>
PCL_COSECTION_INLINE void
chebyshev (const Real* __restrict rhs, const Real* __restrict h, const std::uint16_t* __restrict w,
           const Real* __restrict z, const HessianDiagonal<Real>& diagonal, Real alpha, Real momentum, Real step, int n,
           Real* __restrict d)
{
  const Real* __restrict first = diagonal.first;
  const Real* __restrict second = diagonal.second;
  const Real slope = diagonal.slope;
  const Real constant = diagonal.constant;
  for (int i = 0; i < n; ++i)
  {
    const Real wi = unpackWeight (w[i]);
    d[i] = momentum * d[i] +
           step * (rhs[i] - alpha * h[i] - wi * z[i]) / (alpha * (second[i] + slope * first[i] + constant) + wi);
  }
}

template <typename Real>
PCL_COSECTION_INLINE void
residual (const Real* __restrict rhs, const Real* __restrict h, const std::uint16_t* __restrict w,
          const Real* __restrict z, Real alpha, int n, Real* __restrict out)
{
  for (int i = 0; i < n; ++i)
    out[i] = rhs[i] - alpha * h[i] - static_cast<Real> (unpackWeight (w[i])) * z[i];
}

template <typename Real>
PCL_COSECTION_INLINE void
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

template <typename Real, bool has_first, bool has_second>
PCL_COSECTION_INLINE void
symmetricRun (const SymmetricRun<Real>& run, Real* __restrict out)
{
  const Real* __restrict v = run.v;
  const Real* __restrict diagonal = run.diagonal;
  const Real* __restrict first = run.first;
  const Real* __restrict second = run.second;
  for (int block = run.begin; block < run.begin + run.blocks * run_block; block += run_block)
    for (int i = block; i < block + run_block; ++i)
    {
      Real sum = diagonal[i] * v[i];
      if (has_first)
        sum += first[i - 1] * v[i - 1] + first[i] * v[i + 1];
      if (has_second)
        sum += second[i - 2] * v[i - 2] + second[i] * v[i + 2];
      out[i] += sum;
    }
}

template <typename Real>
PCL_COSECTION_INLINE void
symmetric (const SymmetricRun<Real>* runs, std::size_t count, Real* out)
{
  for (const SymmetricRun<Real>* run = runs; run != runs + count; ++run)
    if (run->second)
      symmetricRun<Real, true, true> (*run, out);
    else if (run->first)
      symmetricRun<Real, true, false> (*run, out);
    else
      symmetricRun<Real, false, false> (*run, out);
}

template <typename Real>
PCL_COSECTION_INLINE void
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

template <typename Real>
PCL_COSECTION_INLINE void
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

template <typename Body>
PCL_COSECTION_INLINE void
forLanes (int n, Body&& body)
{
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l)
      body (i + l, l);
  for (; i < n; ++i)
    body (i, i % lanes);
}

template <typename Real>
PCL_COSECTION_INLINE double
total (const Real (&sums)[lanes])
{
  double sum = 0.0;
  for (const Real s : sums)
    sum += static_cast<double> (s);
  return sum;
}

template <typename Real, bool has_exterior, bool has_intersection, bool outputs>
PCL_COSECTION_INLINE double
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

template <typename Real>
PCL_COSECTION_INLINE void
predict (const EnergyRow& row, const Real* __restrict u, const Real* __restrict p, int n, Real* __restrict residual,
         std::uint16_t* __restrict packed)
{
  for (int i = 0; i < n; ++i)
  {
    float weight = row.weight[i];
    Real r = residual[i];
    for (const LowerBound* bounds : {row.exterior, row.intersection})
      if (bounds)
      {
        const Real violation = static_cast<Real> (bounds[i].distance ()) - u[i];
        const float before = violation > Real (0) ? bounds[i].weight () : 0.0f;
        const float after = violation - p[i] > Real (0) ? bounds[i].weight () : 0.0f;
        weight += after;
        r += static_cast<Real> (after - before) * violation;
      }
    residual[i] = r;
    packed[i] = packWeight (weight);
  }
}

template <typename Real, bool outputs>
PCL_COSECTION_INLINE double
evaluateBounds (const EnergyRow& row, const Real* h, const Real* u, Real alpha, int n, Real* residual,
                std::uint16_t* packed)
{
  if (row.exterior && row.intersection)
    return evaluateTerms<Real, true, true, outputs> (row, h, u, alpha, n, residual, packed);
  if (row.exterior)
    return evaluateTerms<Real, true, false, outputs> (row, h, u, alpha, n, residual, packed);
  if (row.intersection)
    return evaluateTerms<Real, false, true, outputs> (row, h, u, alpha, n, residual, packed);
  return evaluateTerms<Real, false, false, outputs> (row, h, u, alpha, n, residual, packed);
}

template <typename Real, bool has_exterior, bool has_intersection>
PCL_COSECTION_INLINE LinePair
boundTerms (const EnergyRow& row, const Real* __restrict u, const Real* __restrict p, Real t_1, Real t_2, int n)
{
  LinePair derivatives;
  constexpr int block = 512; // short enough for sums in Real
  for (int begin = 0; begin < n; begin += block)
  {
    Real slopes[2][lanes] = {};
    Real curvatures[2][lanes] = {};
    forLanes (n - begin < block ? n - begin : block, [&] (int at, int l) {
      const int i = begin + at;
      const Real along = p[i];
      const auto addBound = [&] (const LowerBound& bound) {
        const Real distance = static_cast<Real> (bound.distance ()) - u[i];
        const Real weighted = static_cast<Real> (bound.weight ()) * along;
        const auto addAt = [&] (Real t, Real& slope, Real& curvature) {
          const Real violation = distance - t * along;
          const Real pull = violation > Real (0) ? weighted : Real (0);
          slope -= pull * violation;
          curvature += pull * along;
        };
        addAt (t_1, slopes[0][l], curvatures[0][l]);
        addAt (t_2, slopes[1][l], curvatures[1][l]);
      };
      if (has_exterior)
        addBound (row.exterior[i]);
      if (has_intersection)
        addBound (row.intersection[i]);
    });
    derivatives += {{total (slopes[0]), total (curvatures[0])}, {total (slopes[1]), total (curvatures[1])}};
  }
  return derivatives;
}

template <typename Real>
PCL_COSECTION_INLINE LinePair
boundDerivatives (const EnergyRow& row, const Real* u, const Real* p, Real t_1, Real t_2, int n)
{
  if (row.exterior && row.intersection)
    return boundTerms<Real, true, true> (row, u, p, t_1, t_2, n);
  if (row.exterior)
    return boundTerms<Real, true, false> (row, u, p, t_1, t_2, n);
  if (row.intersection)
    return boundTerms<Real, false, true> (row, u, p, t_1, t_2, n);
  return {};
}

template <typename Real>
PCL_COSECTION_INLINE DirectionProducts
directionProducts (const float* __restrict weight, const std::uint16_t* __restrict packed,
                   const Real* __restrict residual, const Real* __restrict h, const Real* __restrict z,
                   const Real* __restrict p, Real alpha, int n)
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
  return {total (sums[0]), total (sums[1]), total (sums[2]), total (sums[3]),
          total (sums[4]), total (sums[5]), total (sums[6])};
}

template <typename Real>
PCL_COSECTION_INLINE SquaredChange
advance (const Real* __restrict p, Real t, Real band, int n, Real* __restrict u)
{
  Real sums[lanes] = {};
  Real counts[lanes] = {};
  Real largest[lanes] = {};
  forLanes (n, [&] (int i, int l) {
    const Real before = u[i];
    const Real change = t * p[i];
    const Real after = before + change;
    u[i] = after;
    const bool near = (before < band && before > -band) || (after < band && after > -band);
    const Real squared = near ? change * change : Real (0);
    sums[l] += squared;
    counts[l] += near ? Real (1) : Real (0);
    largest[l] = squared > largest[l] ? squared : largest[l];
  });
  return {total (sums), total (counts), static_cast<double> (*std::max_element (largest, largest + lanes))};
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
  PCL_COSECTION_MULTIVERSION void symmetricRuns (const SymmetricRun<Real>* runs, std::size_t count, Real* out)       \
  { symmetric<Real> (runs, count, out); }                                                                            \
  PCL_COSECTION_MULTIVERSION void contractRows (const Real* const* mass, const Real* const* first,                   \
    const Real* const* second, const AxisCoefficients<Real>& c, int n, Real* out_mass, Real* out_first,              \
    Real* out_second)                                                                                                \
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
  PCL_COSECTION_MULTIVERSION void predictRow (const EnergyRow& row, const Real* u, const Real* p, int n,             \
    Real* residual, std::uint16_t* packed)                                                                           \
  { predict<Real> (row, u, p, n, residual, packed); }                                                                \
  PCL_COSECTION_MULTIVERSION LinePair boundsRow (const EnergyRow& row, const Real* u, const Real* p, Real t_1,       \
    Real t_2, int n)                                                                                                 \
  { return boundDerivatives<Real> (row, u, p, t_1, t_2, n); }                                                        \
  PCL_COSECTION_MULTIVERSION DirectionProducts directionRow (const float* weight, const std::uint16_t* packed,       \
    const Real* residual, const Real* h, const Real* z, const Real* p, Real alpha, int n)                            \
  { return directionProducts<Real> (weight, packed, residual, h, z, p, alpha, n); }                                  \
  PCL_COSECTION_MULTIVERSION SquaredChange advanceRow (const Real* p, Real t, Real band, int n, Real* u)             \
  { return advance<Real> (p, t, band, n, u); }                                                                       \
  PCL_COSECTION_MULTIVERSION void pentadiagonalRow (const Real* in, const Real* const* coefficients, int n, Real* out)\
  { pentadiagonal<Real> (in, coefficients, n, out); }
// clang-format on

PCL_COSECTION_ROW_KERNELS (float)
PCL_COSECTION_ROW_KERNELS (double)

} // namespace pcl::cosection::kernels
