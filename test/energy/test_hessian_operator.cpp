// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/hessian_definition.h"

#include "pcl_cosection/energy/solver/hessian_operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

template <typename Real>
std::vector<Real>
randomField (const Eigen::Vector3i& dims, unsigned seed)
{
  std::mt19937 generator (seed);
  std::uniform_real_distribution<double> uniform (-1.0, 1.0);
  std::vector<Real> u (dims.prod ());
  for (Real& value : u)
    value = static_cast<Real> (uniform (generator));
  return u;
}

/** \brief Samples of f (i, j, k) at every voxel. */
template <typename Real, typename Function>
std::vector<Real>
sampledField (const Eigen::Vector3i& dims, Function&& f)
{
  std::vector<Real> u;
  for (int k = 0; k < dims.z (); ++k)
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
        u.push_back (static_cast<Real> (f (i, j, k)));
  return u;
}

template <typename Real>
std::vector<Real>
applied (const Eigen::Vector3i& dims, const std::vector<Real>& u, int threads = 1)
{
  std::vector<Real> out;
  HessianOperator<Real> (dims, threads).apply (u, out);
  return out;
}

template <typename Real>
double
dot (const std::vector<Real>& a, const std::vector<Real>& b)
{
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size (); ++n)
    sum += static_cast<double> (a[n]) * b[n];
  return sum;
}

/** \brief Largest error of a product with a field of values up to 1: rows sum up to 144 in magnitude. */
template <typename Real>
double
rounding ()
{
  return 500.0 * std::numeric_limits<Real>::epsilon ();
}

template <typename Real>
void
expectNear (const std::vector<Real>& a, const std::vector<double>& b, double tolerance)
{
  ASSERT_EQ (a.size (), b.size ());
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size (); ++n)
    largest = std::max (largest, std::abs (static_cast<double> (a[n]) - b[n]));
  EXPECT_LE (largest, tolerance);
}

template <typename Real>
void
checkDefinition (const Eigen::Vector3i& dims)
{
  const std::vector<Difference> definition = hessianDifferences (dims);
  const std::vector<Real> u = randomField<Real> (dims, 1);
  expectNear (applied (dims, u), hessianProduct (definition, {u.begin (), u.end ()}), rounding<Real> ());
}

template <typename Real>
void
checkSymmetry (const Eigen::Vector3i& dims)
{
  const std::vector<Real> u = randomField<Real> (dims, 2);
  const std::vector<Real> v = randomField<Real> (dims, 3);
  const double scale = std::sqrt (dot (u, u) * dot (v, v));
  EXPECT_NEAR (dot (applied (dims, u), v), dot (u, applied (dims, v)), rounding<Real> () * scale);
  EXPECT_GE (dot (u, applied (dims, u)), -rounding<Real> () * scale);
}

template <typename Real>
void
checkAffineFields (const Eigen::Vector3i& dims)
{
  // Coefficients without rounding: the answer is zero, not just small.
  const std::vector<Real> u = sampledField<Real> (
      dims, [] (int i, int j, int k) { return 3.5 + 0.75 * i - 1.25 * j + 2.0 * k; });
  const std::vector<Real> product = applied (dims, u);
  EXPECT_TRUE (std::all_of (product.begin (), product.end (), [] (Real value) { return value == Real (0); }));
}

template <typename Real>
void
checkDiagonal (const Eigen::Vector3i& dims)
{
  const std::vector<Real> diagonal = HessianOperator<Real> (dims, 1).diagonal ();
  ASSERT_EQ (static_cast<int> (diagonal.size ()), dims.prod ());
  std::vector<Real> probe (diagonal.size (), Real (0));
  for (std::size_t n = 0; n < probe.size (); ++n)
  {
    probe[n] = Real (1);
    EXPECT_EQ (diagonal[n], applied (dims, probe)[n]) << "voxel " << n;
    probe[n] = Real (0);
  }
}

class HessianOperatorTest : public testing::TestWithParam<Eigen::Vector3i>
{};

std::string
dimsName (const testing::TestParamInfo<Eigen::Vector3i>& info)
{
  return std::to_string (info.param.x ()) + "x" + std::to_string (info.param.y ()) + "x" +
         std::to_string (info.param.z ());
}

} // namespace

TEST_P (HessianOperatorTest, EqualsItsDefinition)
{
  checkDefinition<float> (GetParam ());
  checkDefinition<double> (GetParam ());
}

TEST_P (HessianOperatorTest, IsSymmetricAndPositive)
{
  checkSymmetry<float> (GetParam ());
  checkSymmetry<double> (GetParam ());
}

TEST_P (HessianOperatorTest, KillsAffineFieldsAlsoAtTheBorder)
{
  checkAffineFields<float> (GetParam ());
  checkAffineFields<double> (GetParam ());
}

TEST_P (HessianOperatorTest, DiagonalMatchesProbing)
{
  checkDiagonal<float> (GetParam ());
  checkDiagonal<double> (GetParam ());
}

INSTANTIATE_TEST_SUITE_P (Grids, HessianOperatorTest,
                          testing::Values (Eigen::Vector3i (5, 9, 14), Eigen::Vector3i (8, 8, 8),
                                           Eigen::Vector3i (2, 3, 4), Eigen::Vector3i (1, 7, 1),
                                           Eigen::Vector3i (1, 6, 5), Eigen::Vector3i (6, 1, 5),
                                           Eigen::Vector3i (9, 5, 1), Eigen::Vector3i (2, 2, 2),
                                           Eigen::Vector3i (35, 3, 4), Eigen::Vector3i (1, 1, 1),
                                           Eigen::Vector3i (3, 17, 2)),
                          dimsName);

TEST (HessianOperatorStencil, HasTwentyFiveEntriesInTheInterior)
{
  const Eigen::Vector3i dims (9, 8, 7);
  const Eigen::Vector3i centre (4, 3, 3);
  const std::vector<double> row = applied (dims, sampledField<double> (dims, [&] (int i, int j, int k) {
                                             return Eigen::Vector3i (i, j, k) == centre ? 1.0 : 0.0;
                                           }));
  const std::vector<double> expected = sampledField<double> (dims, [&] (int i, int j, int k) {
    const Eigen::Vector3i offset = (Eigen::Vector3i (i, j, k) - centre).cwiseAbs ();
    switch (offset.sum ())
    {
    case 0:
      return 42.0;
    case 1:
      return -12.0;
    case 2:
      return offset.maxCoeff () == 2 ? 1.0 : 2.0;
    default:
      return 0.0;
    }
  });
  EXPECT_EQ (row, expected);
  EXPECT_EQ (std::count_if (row.begin (), row.end (), [] (double value) { return value != 0.0; }), 25);
}

TEST (HessianOperatorStencil, ResistsEveryQuadraticField)
{
  const Eigen::Vector3i dims (6, 5, 4);
  const auto energy = [&] (auto&& f) {
    const std::vector<double> u = sampledField<double> (dims, f);
    return dot (u, applied (dims, u));
  };
  EXPECT_DOUBLE_EQ (energy ([] (int i, int, int) { return i * i; }), 4.0 * (4 * 5 * 4));
  EXPECT_DOUBLE_EQ (energy ([] (int, int, int k) { return k * k; }), 4.0 * (6 * 5 * 2));
  EXPECT_DOUBLE_EQ (energy ([] (int i, int j, int) { return i * j; }), 2.0 * (5 * 4 * 4));
  EXPECT_DOUBLE_EQ (energy ([] (int, int j, int k) { return j * k; }), 2.0 * (6 * 4 * 3));
}

TEST (HessianOperatorThreads, DoNotChangeABit)
{
  const Eigen::Vector3i dims (41, 37, 50);
  const std::vector<float> u = randomField<float> (dims, 4);
  const std::vector<float> one = applied (dims, u, 1);
  for (const int threads : {2, 3})
  {
    const std::vector<float> many = applied (dims, u, threads);
    EXPECT_EQ (std::memcmp (one.data (), many.data (), one.size () * sizeof (float)), 0) << threads << " threads";
  }
}
