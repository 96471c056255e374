// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/solver.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl::cosection::kernels {

// Loops over one row of voxels. They contain all of the solver's arithmetic and are compiled for
// several instruction sets (see multiversion.h). Overloads for float and double.

/** \brief A row and its four neighbours in y and z; at the border, the row itself replaces a neighbour. */
template <typename Real> struct RowNeighbours
{
  const Real* center;
  const Real* y_minus;
  const Real* y_plus;
  const Real* z_minus;
  const Real* z_plus;
};

/** \brief out = sum over the existing 6-neighbours of (u - u_neighbour): minus the 7-point
 * Laplacian with natural boundary. Differences first, which keeps float accurate to the local
 * variation of u rather than to its magnitude. */
void laplaceRow (const RowNeighbours<float>& u, int n, float* out);
void laplaceRow (const RowNeighbours<double>& u, int n, double* out);

/** \brief out -= a - b, element by element. */
void subtractDifference (const float* a, const float* b, int n, float* out);
void subtractDifference (const double* a, const double* b, int n, double* out);

/** \brief The diagonal of H^T H along a row: second[i] + slope first[i] + constant. */
template <typename Real> struct HessianDiagonal
{
  const Real* first;
  const Real* second;
  Real slope;
  Real constant;
};

/** \brief One step of the Chebyshev smoother on the finest level:
 *     d = momentum d + step (rhs - alpha h - w z) / (alpha diagonal + w). */
void chebyshevRow (const float* rhs, const float* h, const std::uint16_t* w, const float* z,
                   const HessianDiagonal<float>& diagonal, float alpha, float momentum, float step, int n, float* d);
void chebyshevRow (const double* rhs, const double* h, const std::uint16_t* w, const double* z,
                   const HessianDiagonal<double>& diagonal, double alpha, double momentum, double step, int n,
                   double* d);

/** \brief out = rhs - alpha h - w z. */
void residualRow (const float* rhs, const float* h, const std::uint16_t* w, const float* z, float alpha, int n,
                  float* out);
void residualRow (const double* rhs, const double* h, const std::uint16_t* w, const double* z, double alpha, int n,
                  double* out);

/** \brief out += a. */
void addRow (const float* a, int n, float* out);
void addRow (const double* a, int n, double* out);

/** \brief out += factor a. */
void addScaledRow (const float* a, float factor, int n, float* out);
void addScaledRow (const double* a, double factor, int n, double* out);

/** \brief out = a + factor out. */
void scaleAddRow (const float* a, float factor, int n, float* out);
void scaleAddRow (const double* a, double factor, int n, double* out);

/** \brief Runs are processed in blocks of so many values. */
constexpr int run_block = 8;

/** \brief A run of rows of a symmetric matrix with diagonals T (i, i) = diagonal[i], T (i, i + 1) = first[i] and
 * T (i, i + 2) = second[i] (\a first and \a second may be null), times a row v. Two values before and
 * behind the run must be readable; entries that would couple beyond the matrix must be zero. */
template <typename Real> struct SymmetricRun
{
  const Real* v;
  const Real* diagonal;
  const Real* first;
  const Real* second;
  int begin;  ///< first row of T
  int blocks; ///< of run_block rows
};

/** \brief out[i] += (T v)[i] for every row of every run, one after the other. */
void symmetricRuns (const SymmetricRun<float>* runs, std::size_t count, float* out);
void symmetricRuns (const SymmetricRun<double>* runs, std::size_t count, double* out);

/** \brief Rows of the three one-dimensional factors along an axis, at offsets -2 ... 2. */
template <typename Real> struct AxisCoefficients
{
  Real mass[5];
  Real first[5];
  Real second[5];
};

/** \brief Contraction along y of the three fields contracted along x (mass, first, second):
 *     out_second = mass (second) + second (mass) + 2 first (first)
 *     out_first  = 2 (mass (first) + first (mass))
 *     out_mass   = mass (mass)
 * \param[in] mass, first, second five rows each */
void contractRows (const float* const* mass, const float* const* first, const float* const* second,
                   const AxisCoefficients<float>& c, int n, float* out_mass, float* out_first, float* out_second);
void contractRows (const double* const* mass, const double* const* first, const double* const* second,
                   const AxisCoefficients<double>& c, int n, double* out_mass, double* out_first, double* out_second);

/** \brief Last contraction: out = mass (second) + first (first) + second (mass). */
void contractPlanes (const float* const* mass, const float* const* first, const float* const* second,
                     const AxisCoefficients<float>& c, int n, float* out);
void contractPlanes (const double* const* mass, const double* const* first, const double* const* second,
                     const AxisCoefficients<double>& c, int n, double* out);

/** \brief d = momentum d + step inverse_diagonal (rhs - product). */
void chebyshevStepRow (const float* rhs, const float* product, const float* inverse_diagonal, float momentum,
                       float step, int n, float* d);
void chebyshevStepRow (const double* rhs, const double* product, const double* inverse_diagonal, double momentum,
                       double step, int n, double* d);

/** \brief out = sum_k coefficients[k][i] in[i + k - 2], k = 0 ... 4, for a row with two readable
 * values before and behind. */
void pentadiagonalRow (const float* in, const float* const* coefficients, int n, float* out);
void pentadiagonalRow (const double* in, const double* const* coefficients, int n, double* out);

/** \brief The terms of the energy along a row. */
struct EnergyRow
{
  const float* weight;
  const float* weighted_target;
  const LowerBound* exterior;     ///< or null
  const LowerBound* intersection; ///< or null
};

/** \brief The energy of a row; \a h is the row of H^T H u. \a residual (minus half the gradient) and
 * \a packed (W plus the weights of active bounds) are written, or both null. */
double evaluateRow (const EnergyRow& row, const float* h, const float* u, float alpha, int n, float* residual,
                    std::uint16_t* packed);
double evaluateRow (const EnergyRow& row, const double* h, const double* u, double alpha, int n, double* residual,
                    std::uint16_t* packed);

/** \brief Exchange the active set at u for that at u + p: then \a residual and \a packed are those of the
 * quadratic function of u that the energy is near u + p. */
void predictRow (const EnergyRow& row, const float* u, const float* p, int n, float* residual, std::uint16_t* packed);
void predictRow (const EnergyRow& row, const double* u, const double* p, int n, double* residual,
                 std::uint16_t* packed);

/** \brief Slope and curvature of half the energy of bounds along a line. */
struct LineDerivatives
{
  double slope = 0.0;
  double curvature = 0.0;

  void operator+= (const LineDerivatives& other)
  {
    slope += other.slope;
    curvature += other.curvature;
  }
};

/** \brief LineDerivatives at two points of a line. */
struct LinePair
{
  LineDerivatives first;
  LineDerivatives second;

  void operator+= (const LinePair& other)
  {
    first += other.first;
    second += other.second;
  }
};

/** \brief The derivatives of the bounds' energy of a row, at u + t_1 p and u + t_2 p. */
LinePair boundsRow (const EnergyRow& row, const float* u, const float* p, float t_1, float t_2, int n);
LinePair boundsRow (const EnergyRow& row, const double* u, const double* p, double t_1, double t_2, int n);

/** \brief Inner products of a new direction z and the last one p, with the quadratic part S = W + alpha H^T H
 * of half the energy, with the active bounds A, and with the residual. */
struct DirectionProducts
{
  double z_S_z = 0.0;
  double z_S_p = 0.0;
  double z_A_z = 0.0;
  double z_A_p = 0.0;
  double p_A_p = 0.0;
  double r_z = 0.0;
  double r_p = 0.0;

  void operator+= (const DirectionProducts& other);
};

/** \brief The inner products of one row; \a h is the row of H^T H z. */
DirectionProducts directionRow (const float* weight, const std::uint16_t* packed, const float* residual, const float* h,
                                const float* z, const float* p, float alpha, int n);
DirectionProducts directionRow (const float* weight, const std::uint16_t* packed, const double* residual,
                                const double* h, const double* z, const double* p, double alpha, int n);

/** \brief A sum of squared changes, of how many voxels, and the largest of them. */
struct SquaredChange
{
  double sum = 0.0;
  double voxels = 0.0;
  double largest = 0.0;

  void operator+= (const SquaredChange& other)
  {
    sum += other.sum;
    voxels += other.voxels;
    largest = other.largest > largest ? other.largest : largest;
  }

  double rootMean () const { return voxels > 0.0 ? std::sqrt (sum / voxels) : 0.0; }
};

/** \brief u += t p; returns the changes where |u| < band before or after. */
SquaredChange advanceRow (const float* p, float t, float band, int n, float* u);
SquaredChange advanceRow (const double* p, double t, double band, int n, double* u);

/** \brief Weights are kept in the upper half of a float: they only steer the preconditioner. */
inline std::uint16_t
packWeight (float w)
{
  union
  {
    float f;
    std::uint32_t u;
  } bits{w};
  return static_cast<std::uint16_t> ((bits.u + 0x8000u) >> 16);
}

inline float
unpackWeight (std::uint16_t w)
{
  union
  {
    std::uint32_t u;
    float f;
  } bits{static_cast<std::uint32_t> (w) << 16};
  return bits.f;
}

} // namespace pcl::cosection::kernels
