// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/hessian_definition.h"

#include <pcl/cosection/surface/solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

enum PresentBounds
{
  no_bounds = 0,
  exterior = 1,
  intersection = 2,
  both = 3,
};

std::vector<LowerBound>
randomBounds (std::size_t size, std::mt19937& generator)
{
  std::uniform_real_distribution<float> distance (0.0f, 4.0f);
  std::uniform_real_distribution<float> weight (0.001f, 0.5f);
  std::bernoulli_distribution present (0.4);
  std::vector<LowerBound> bounds (size);
  for (LowerBound& bound : bounds)
    if (present (generator))
      bound = LowerBound (distance (generator), weight (generator));
  return bounds;
}

EnergyProblem
randomProblem (const Eigen::Vector3i& dims, int bounds)
{
  std::mt19937 generator (7);
  std::uniform_real_distribution<float> uniform (0.0f, 1.0f);
  EnergyProblem problem;
  problem.dims = dims;
  problem.alpha = 0.03;
  for (std::size_t n = 0; n < problem.size (); ++n)
  {
    const float weight = uniform (generator) < 0.5f ? uniform (generator) : 0.0f;
    problem.weight.push_back (weight);
    problem.weighted_target.push_back (weight * (4.0f * uniform (generator) - 2.0f));
  }
  if (bounds & exterior)
    problem.exterior = randomBounds (problem.size (), generator);
  if (bounds & intersection)
    problem.intersection = randomBounds (problem.size (), generator);
  return problem;
}

std::vector<double>
randomField (std::size_t size)
{
  std::mt19937 generator (8);
  std::uniform_real_distribution<double> uniform (-3.0, 3.0);
  std::vector<double> u (size);
  for (double& value : u)
    value = uniform (generator);
  return u;
}

/** \brief The energy by its definition, term by term. */
double
energyByDefinition (const EnergyProblem& problem, const std::vector<double>& u)
{
  double sum = problem.alpha * hessianEnergy (hessianDifferences (problem.dims), u);
  for (std::size_t n = 0; n < u.size (); ++n)
  {
    sum += problem.weight[n] * u[n] * u[n] - 2.0 * problem.weighted_target[n] * u[n];
    for (const auto* bounds : {&problem.exterior, &problem.intersection})
      if (!bounds->empty ())
      {
        const double violation = std::max (0.0, (*bounds)[n].distance () - u[n]);
        sum += (*bounds)[n].weight () * violation * violation;
      }
  }
  return sum;
}

double
total (const std::vector<float>& values)
{
  return std::accumulate (values.begin (), values.end (), 0.0);
}

double
totalWeight (const std::vector<LowerBound>& bounds)
{
  return std::accumulate (bounds.begin (), bounds.end (), 0.0,
                          [] (double sum, const LowerBound& b) { return sum + b.weight (); });
}

struct EnergyCase
{
  Eigen::Vector3i dims;
  int bounds;
};

class EnergyTest : public testing::TestWithParam<EnergyCase>
{};

std::string
energyCaseName (const testing::TestParamInfo<EnergyCase>& info)
{
  const char* bounds[] = {"NoBounds", "Exterior", "Intersection", "Both"};
  const Eigen::Vector3i& d = info.param.dims;
  return std::to_string (d.x ()) + "x" + std::to_string (d.y ()) + "x" + std::to_string (d.z ()) +
         bounds[info.param.bounds];
}

} // namespace

TEST_P (EnergyTest, EqualsItsDefinition)
{
  const EnergyProblem problem = randomProblem (GetParam ().dims, GetParam ().bounds);
  const std::vector<double> u = randomField (problem.size ());
  const double expected = energyByDefinition (problem, u);
  EXPECT_NEAR (evaluateEnergy (problem, u), expected, 1e-11 * std::abs (expected));
  const std::vector<float> rounded (u.begin (), u.end ());
  EXPECT_NEAR (evaluateEnergy (problem, rounded), expected, 1e-5 * std::abs (expected));
}

TEST_P (EnergyTest, ResidualIsMinusHalfTheGradient)
{
  const EnergyProblem problem = randomProblem (GetParam ().dims, GetParam ().bounds);
  std::vector<double> u = randomField (problem.size ());
  std::vector<double> residual;
  evaluateEnergy (problem, u, &residual);
  ASSERT_EQ (residual.size (), u.size ());
  constexpr double step = 1e-5;
  for (std::size_t n = 0; n < u.size (); ++n)
  {
    const double at = u[n];
    u[n] = at + step;
    const double after = evaluateEnergy (problem, u);
    u[n] = at - step;
    const double before = evaluateEnergy (problem, u);
    u[n] = at;
    EXPECT_NEAR (residual[n], -0.5 * (after - before) / (2.0 * step), 1e-5) << "voxel " << n;
  }
}

TEST_P (EnergyTest, CoarseningConservesWeights)
{
  const EnergyProblem problem = randomProblem (GetParam ().dims, GetParam ().bounds);
  const EnergyProblem coarse = coarsen (problem, true);
  EXPECT_EQ (coarse.dims, Eigen::Vector3i ((problem.dims.array () + 1) / 2));
  EXPECT_EQ (coarse.alpha, 0.5 * problem.alpha);
  EXPECT_NEAR (total (coarse.weight), total (problem.weight), 1e-5 * total (problem.weight));
  EXPECT_NEAR (total (coarse.weighted_target), total (problem.weighted_target), 1e-5 * total (problem.weight));
  // The weight of a bound has eight bits, so its sums are good to 1/256 each.
  EXPECT_NEAR (totalWeight (coarse.exterior), totalWeight (problem.exterior), totalWeight (problem.exterior) / 256.0);
  EXPECT_NEAR (totalWeight (coarse.intersection), totalWeight (problem.intersection),
               totalWeight (problem.intersection) / 256.0);
  EXPECT_EQ (coarse.exterior.empty (), problem.exterior.empty ());
  EXPECT_EQ (coarse.intersection.empty (), problem.intersection.empty ());

  const EnergyProblem unbounded = coarsen (problem, false);
  EXPECT_TRUE (unbounded.exterior.empty ());
  EXPECT_TRUE (unbounded.intersection.empty ());
  EXPECT_EQ (unbounded.weight, coarse.weight);
}

INSTANTIATE_TEST_SUITE_P (Problems, EnergyTest,
                          testing::Values (EnergyCase{{6, 5, 4}, no_bounds}, EnergyCase{{6, 5, 4}, exterior},
                                           EnergyCase{{5, 4, 7}, intersection}, EnergyCase{{5, 4, 7}, both},
                                           EnergyCase{{1, 6, 9}, both}, EnergyCase{{17, 3, 2}, both},
                                           EnergyCase{{1, 1, 8}, both}),
                          energyCaseName);

TEST (Coarsening, AveragesDistancesByWeight)
{
  EnergyProblem problem = randomProblem ({2, 2, 2}, no_bounds);
  problem.exterior.resize (8);
  problem.exterior[1] = LowerBound (4.0f, 0.25f);
  problem.exterior[6] = LowerBound (1.0f, 0.5f);
  const EnergyProblem coarse = coarsen (problem, true);
  ASSERT_EQ (coarse.exterior.size (), 1u);
  EXPECT_NEAR (coarse.exterior[0].distance (), 2.0, 1.0 / 256.0);
  EXPECT_EQ (coarse.exterior[0].weight (), 0.75f);
}

/** \brief A smooth field has the same energy on both grids, except near the border. */
TEST (Coarsening, KeepsTheEnergyOfSmoothFields)
{
  constexpr int size = 40;
  EnergyProblem problem = randomProblem ({size, size, size}, no_bounds);
  std::fill (problem.weight.begin (), problem.weight.end (), 0.0f);
  std::fill (problem.weighted_target.begin (), problem.weighted_target.end (), 0.0f);
  const EnergyProblem coarse = coarsen (problem, true);
  const auto energy = [] (const EnergyProblem& p, double scale, auto&& f) {
    std::vector<double> u;
    for (int k = 0; k < p.dims.z (); ++k)
      for (int j = 0; j < p.dims.y (); ++j)
        for (int i = 0; i < p.dims.x (); ++i)
          u.push_back (f (scale * i, scale * j, scale * k));
    return evaluateEnergy (p, u);
  };
  const auto squared = [] (double x, double, double) { return 0.01 * x * x; };
  const auto product = [] (double, double y, double z) { return 0.01 * y * z; };
  EXPECT_NEAR (energy (coarse, 2.0, squared) / energy (problem, 1.0, squared), 1.0, 4.0 / size);
  EXPECT_NEAR (energy (coarse, 2.0, product) / energy (problem, 1.0, product), 1.0, 4.0 / size);
}

TEST (LowerBoundTest, KeepsDistanceAndWeightToTheirPrecision)
{
  for (const float distance : {0.0f, 0.3f, 1.0f, 7.77f, 254.9f})
    EXPECT_NEAR (LowerBound (distance, 1.0f).distance (), distance, 1.0f / 512.0f);
  EXPECT_EQ (LowerBound (1000.0f, 1.0f).distance (), 255.0f);
  for (const float weight : {0.0001f, 0.01f, 0.3f, 10.0f, 12345.0f})
    EXPECT_NEAR (LowerBound (1.0f, weight).weight (), weight, weight / 256.0f);
  EXPECT_FALSE (LowerBound ());
  EXPECT_FALSE (LowerBound (1.0f, 0.0f));
  EXPECT_TRUE (LowerBound (0.0f, 0.01f));
}
