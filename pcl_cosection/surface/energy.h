// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/energy_problem.h>
#include <pcl/cosection/surface/hessian_operator.h>

#include <cstdint>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief E (u), with by-products of the same pass unless both are null.
 * \param[out] residual minus half the gradient
 * \param[out] weights W plus the weights of the active bounds, packed: the diagonal part of half the
 * (generalised) Hessian of E at u */
template <typename Real> double
evaluate (const EnergyProblem& problem, const HessianOperator<Real>& hessian, const Real* u, Real* residual,
          std::uint16_t* weights);

/** \brief Derivatives of half the bounds' energy along a line. */
struct LineDerivatives
{
  double slope = 0.0;
  double curvature = 0.0;
};

/** \brief At u + t p. \param[in] threads 0: all */
template <typename Real> LineDerivatives
boundDerivatives (const EnergyProblem& problem, const Real* u, const Real* p, double t, int threads);

} // namespace cosection
} // namespace pcl
