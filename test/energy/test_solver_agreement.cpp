// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/solver_problems.h"

#include <pcl/cosection/surface/solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double band_vox = 1.5;

struct AgreementCase
{
  ProblemKind kind;
  Eigen::Vector3i dims;
};

class SolverAgreement : public testing::TestWithParam<AgreementCase>
{
protected:
  SolverSummary minimise (SolverType type, std::vector<double>& u) const
  {
    SolverOptions options;
    options.type = type;
    options.max_iterations = 20000;
    options.tolerance_vox = 1e-6;
    options.threads = 1;
    return solve (problem_, options, u);
  }

  const EnergyProblem problem_ = makeProblem (GetParam ().kind, GetParam ().dims);
};

std::string
agreementCaseName (const testing::TestParamInfo<AgreementCase>& info)
{
  const Eigen::Vector3i& d = info.param.dims;
  return nameOf (info.param.kind) + std::to_string (d.x ()) + "x" + std::to_string (d.y ()) + "x" +
         std::to_string (d.z ());
}

} // namespace

TEST_P (SolverAgreement, FastJacobiAndMultigridFindTheSameMinimum)
{
  std::vector<double> a, b;
  const SolverSummary multigrid = minimise (SolverType::Multigrid, a);
  const SolverSummary fast_jacobi = minimise (SolverType::FastJacobi, b);
  EXPECT_TRUE (multigrid.converged ());
  EXPECT_TRUE (fast_jacobi.converged ());
  EXPECT_NEAR (multigrid.energy, fast_jacobi.energy, 1e-6 * std::abs (multigrid.energy));
  ASSERT_EQ (a.size (), problem_.size ());
  ASSERT_EQ (b.size (), problem_.size ());
  double farthest = 0.0;
  std::size_t near = 0;
  for (std::size_t n = 0; n < a.size (); ++n)
    if (std::min (std::abs (a[n]), std::abs (b[n])) < band_vox)
    {
      ++near;
      farthest = std::max (farthest, std::abs (a[n] - b[n]));
    }
  EXPECT_LE (farthest, 0.02);
  EXPECT_GT (near, a.size () / 20);
}

TEST_P (SolverAgreement, EnergiesFallInEveryIteration)
{
  for (const SolverType type : {SolverType::Multigrid, SolverType::FastJacobi})
  {
    std::vector<double> u;
    const SolverSummary summary = minimise (type, u);
    ASSERT_EQ (static_cast<int> (summary.energies.size ()), summary.iterations + 1);
    EXPECT_EQ (summary.energy, summary.energies.back ());
    for (std::size_t i = 1; i < summary.energies.size (); ++i)
      ASSERT_LE (summary.energies[i], summary.energies[i - 1] + 1e-12 * std::abs (summary.energy)) << "iteration " << i;
  }
}

TEST_P (SolverAgreement, TheGradientVanishesAtTheMinimum)
{
  std::vector<double> u, residual;
  const std::vector<double> zero (problem_.size (), 0.0);
  minimise (SolverType::Multigrid, u);
  const auto largest = [] (const std::vector<double>& values) {
    return std::abs (*std::max_element (values.begin (), values.end (),
                                        [] (double a, double b) { return std::abs (a) < std::abs (b); }));
  };
  evaluateEnergy (problem_, zero, &residual);
  const double before = largest (residual);
  evaluateEnergy (problem_, u, &residual);
  EXPECT_LE (largest (residual), 1e-6 * before);
}

INSTANTIATE_TEST_SUITE_P (
    Problems, SolverAgreement,
    testing::Values (AgreementCase{ProblemKind::HalfSphere, {12, 12, 12}},
                     AgreementCase{ProblemKind::Hull, {9, 14, 13}}, AgreementCase{ProblemKind::All, {14, 14, 14}},
                     AgreementCase{ProblemKind::All, {13, 9, 14}}, AgreementCase{ProblemKind::All, {1, 13, 12}},
                     AgreementCase{ProblemKind::Random, {24, 24, 24}}, AgreementCase{ProblemKind::Random, {5, 16, 11}},
                     AgreementCase{ProblemKind::Random, {2, 3, 24}}),
    agreementCaseName);
