// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/solver_problems.h"

#include <pcl/cosection/surface/solver.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class FastJacobiCycles : public testing::TestWithParam<int>
{};

} // namespace

/** \brief In long cycles the active set changes, which leaves errors undamped or amplified. The solver must not report
 * convergence away from the minimum. */
TEST_P (FastJacobiCycles, ConvergeToTheMinimumOrDoNotClaimTo)
{
  for (const ProblemKind kind : {ProblemKind::All, ProblemKind::Random})
  {
    const EnergyProblem problem = makeProblem (kind, {1, 13, 12});
    SolverOptions options;
    options.tolerance_vox = 1e-6;
    options.max_iterations = 500;
    options.threads = 1;
    std::vector<double> u, v;
    const SolverSummary minimum = solve (problem, options, u);
    options.type = SolverType::FastJacobi;
    options.cycle_length = GetParam ();
    options.max_iterations = 20000 / GetParam () + 5;
    const SolverSummary summary = solve (problem, options, v);
    if (summary.converged ())
    {
      EXPECT_NEAR (summary.energy, minimum.energy, 1e-6 * std::abs (minimum.energy)) << nameOf (kind);
    }
    EXPECT_LE (summary.energy, summary.energies.front ()) << nameOf (kind);
  }
}

INSTANTIATE_TEST_SUITE_P (Lengths, FastJacobiCycles, testing::Values (1, 20, 50, 100, 400, 1000));
