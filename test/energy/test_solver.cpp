// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/solver_problems.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Conjugate gradients without preconditioner would need nine times as many on a grid three times as long. */
constexpr double largest_growth = 3.0;

SolverOptions
oneThread ()
{
  SolverOptions options;
  options.threads = 1;
  return options;
}

template <typename Real>
std::vector<Real>
solution (const EnergyProblem& problem, const SolverOptions& options, SolverSummary* summary = nullptr)
{
  std::vector<Real> u;
  const SolverSummary s = solve (problem, options, u);
  if (summary)
    *summary = s;
  return u;
}

/** \brief Largest difference where a field is near zero. */
template <typename A, typename B>
double
largestDifference (const std::vector<A>& a, const std::vector<B>& b)
{
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size (); ++n)
    if (std::abs (a[n]) < 1.5)
      largest = std::max (largest, std::abs (static_cast<double> (a[n]) - b[n]));
  return largest;
}

/** \brief Root mean square difference where the field is near zero. */
template <typename A, typename B>
double
meanDifference (const std::vector<A>& a, const std::vector<B>& b)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size (); ++n)
    if (std::abs (a[n]) < 1.5)
    {
      sum += std::pow (static_cast<double> (a[n]) - b[n], 2);
      ++count;
    }
  return std::sqrt (sum / static_cast<double> (std::max<std::size_t> (1, count)));
}

class MultigridSolver : public testing::TestWithParam<ProblemKind>
{};

class AnySolver : public testing::TestWithParam<SolverType>
{
protected:
  AnySolver () { options_.type = GetParam (); }

  SolverOptions options_ = oneThread ();
};

} // namespace

TEST_P (MultigridSolver, FloatFollowsDouble)
{
  const EnergyProblem problem = makeProblem (GetParam (), {32, 29, 35});
  SolverOptions options = oneThread ();
  options.tolerance_vox = 1e-3;
  SolverSummary summary;
  const std::vector<float> u = solution<float> (problem, options, &summary);
  EXPECT_TRUE (summary.converged ());
  for (std::size_t i = 1; i < summary.energies.size (); ++i)
    EXPECT_LE (summary.energies[i], summary.energies[i - 1] + 1e-7 * std::abs (summary.energy)) << "iteration " << i;
  options.tolerance_vox = 1e-7;
  options.max_iterations = 500;
  EXPECT_LE (largestDifference (solution<double> (problem, options), u), 0.01);
}

TEST_P (MultigridSolver, DefaultToleranceIsReached)
{
  const EnergyProblem problem = makeProblem (GetParam (), {40, 33, 36});
  SolverOptions options = oneThread ();
  SolverSummary summary;
  const std::vector<float> u = solution<float> (problem, options, &summary);
  EXPECT_TRUE (summary.converged ());
  options.tolerance_vox = 1e-6;
  options.max_iterations = 500;
  EXPECT_LE (meanDifference (solution<double> (problem, options), u), 0.05);
}

TEST_P (MultigridSolver, PeakToleranceIsReachedEverywhere)
{
  const EnergyProblem problem = makeProblem (GetParam (), {40, 33, 36});
  SolverOptions options = oneThread ();
  options.peak_tolerance_vox = 0.05;
  SolverSummary summary;
  const std::vector<float> u = solution<float> (problem, options, &summary);
  EXPECT_TRUE (summary.converged ());
  options.tolerance_vox = 1e-6;
  options.max_iterations = 500;
  EXPECT_LE (largestDifference (solution<double> (problem, options), u), options.peak_tolerance_vox);
}

TEST_P (MultigridSolver, NeedsHardlyMoreIterationsOnLargerGrids)
{
  SolverOptions options = oneThread ();
  options.tolerance_vox = 1e-3;
  options.max_iterations = 1000;
  SolverSummary small, large;
  solution<float> (makeProblem (GetParam (), {16, 16, 16}), options, &small);
  solution<float> (makeProblem (GetParam (), {48, 48, 48}), options, &large);
  EXPECT_LE (large.iterations, largest_growth * small.iterations);
}

INSTANTIATE_TEST_SUITE_P (Problems, MultigridSolver,
                          testing::Values (ProblemKind::HalfSphere, ProblemKind::Hull, ProblemKind::All,
                                           ProblemKind::Random),
                          [] (const auto& info) { return nameOf (info.param); });

TEST_P (AnySolver, StopsAtOnceWhenStartedAtTheSolution)
{
  const EnergyProblem problem = makeProblem (ProblemKind::All, {14, 12, 13});
  options_.tolerance_vox = 1e-5;
  options_.peak_tolerance_vox = 2e-5;
  options_.max_iterations = 20000;
  std::vector<double> u = solution<double> (problem, options_);
  const std::vector<double> before = u;
  const SolverSummary again = solve (problem, options_, u);
  EXPECT_TRUE (again.converged ());
  EXPECT_LE (again.iterations, 1);
  EXPECT_LE (meanDifference (before, u), 2.0 * options_.tolerance_vox);
  EXPECT_LE (largestDifference (before, u), 2.0 * options_.tolerance_vox);
}

TEST_P (AnySolver, HasNothingToDoWithoutData)
{
  EnergyProblem problem;
  problem.dims = {12, 10, 11};
  problem.weight.assign (problem.size (), 0.0f);
  problem.weighted_target.assign (problem.size (), 0.0f);
  SolverSummary summary;
  const std::vector<float> u = solution<float> (problem, options_, &summary);
  EXPECT_TRUE (summary.converged ());
  EXPECT_LE (summary.iterations, 1);
  EXPECT_TRUE (std::all_of (u.begin (), u.end (), [] (float value) { return value == 0.0f; }));
}

TEST_P (AnySolver, FindsTheMinimumFromAnyStart)
{
  const EnergyProblem problem = makeProblem (ProblemKind::All, {10, 9, 11});
  options_.tolerance_vox = 1e-7;
  options_.max_iterations = 50000;
  const std::vector<double> expected = solution<double> (problem, options_);
  std::vector<double> u (problem.size ());
  for (std::size_t n = 0; n < u.size (); ++n)
    u[n] = 5.0 * std::sin (0.7 * static_cast<double> (n));
  EXPECT_TRUE (solve (problem, options_, u).converged ());
  EXPECT_LE (largestDifference (expected, u), 1e-3);
}

TEST_P (AnySolver, ThreadsDoNotChangeABit)
{
  const EnergyProblem problem = makeProblem (ProblemKind::All, {41, 39, 44});
  options_.max_iterations = 2;
  const std::vector<float> one = solution<float> (problem, options_);
  for (const int threads : {2, 3})
  {
    options_.threads = threads;
    const std::vector<float> many = solution<float> (problem, options_);
    ASSERT_EQ (one.size (), many.size ());
    EXPECT_EQ (std::memcmp (one.data (), many.data (), one.size () * sizeof (float)), 0) << threads << " threads";
  }
}

TEST_P (AnySolver, SaysThatIterationsWereUsedUp)
{
  options_.max_iterations = 2;
  options_.tolerance_vox = 1e-9;
  SolverSummary summary;
  solution<double> (makeProblem (ProblemKind::All, {20, 20, 20}), options_, &summary);
  EXPECT_EQ (summary.termination, Termination::MaxIterations);
  EXPECT_EQ (summary.iterations, 2);
  EXPECT_GT (summary.change_vox, options_.tolerance_vox);
}

TEST_P (AnySolver, IsCancelledByItsCallback)
{
  const EnergyProblem problem = makeProblem (ProblemKind::All, {20, 18, 19});
  options_.tolerance_vox = 1e-9;
  for (const int allowed : {0, 1, 5})
  {
    int calls = 0;
    std::vector<float> u;
    EXPECT_THROW (solve<float> (problem, options_, u, [&] (const std::string&, double) { return calls++ < allowed; }),
                  Cancelled);
    EXPECT_EQ (calls, allowed + 1);
  }
}

TEST_P (AnySolver, ReportsGrowingFractions)
{
  double last = 0.0;
  int calls = 0;
  std::vector<float> u;
  solve<float> (makeProblem (ProblemKind::Hull, {20, 18, 19}), options_, u, [&] (const std::string&, double fraction) {
    EXPECT_GE (fraction, last);
    EXPECT_LE (fraction, 1.0);
    last = fraction;
    ++calls;
    return true;
  });
  EXPECT_GT (calls, 0);
}

INSTANTIATE_TEST_SUITE_P (Solvers, AnySolver, testing::Values (SolverType::Multigrid, SolverType::FastJacobi),
                          [] (const auto& info) {
                            return info.param == SolverType::Multigrid ? "Multigrid" : "FastJacobi";
                          });
