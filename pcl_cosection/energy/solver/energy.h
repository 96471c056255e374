// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "row_kernels.h"

#include "hessian_operator.h"
#include <pcl/cosection/surface/solver.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief The terms of a problem along a row that begins at voxel \a at. */
inline kernels::EnergyRow
energyRow (const EnergyProblem& problem, std::size_t at)
{
  return {problem.weight.data () + at, problem.weighted_target.data () + at,
          problem.exterior.empty () ? nullptr : problem.exterior.data () + at,
          problem.intersection.empty () ? nullptr : problem.intersection.data () + at};
}

/** \brief E (u), with by-products of the same pass unless both are null.
 * \param[out] residual minus half the gradient
 * \param[out] weights W plus the weights of the active bounds, packed: the diagonal part of half the
 * (generalised) Hessian of E at u */
template <typename Real>
double evaluate (const EnergyProblem& problem, const HessianOperator<Real>& hessian, const Real* u, Real* residual,
                 std::uint16_t* weights);

/** \brief Exchange the active set at u for that at u + p: then \a residual and \a weights are those of the
 * quadratic function of u that E is near u + p. \param[in] threads 0: all */
template <typename Real>
void predictActiveSet (const EnergyProblem& problem, const Real* u, const Real* p, Real* residual,
                       std::uint16_t* weights, int threads);

/** \brief Derivatives of half the bounds' energy at u + t_1 p and u + t_2 p, along p.
 * \param[in] threads 0: all */
template <typename Real>
kernels::LinePair boundDerivatives (const EnergyProblem& problem, const Real* u, const Real* p, double t_1, double t_2,
                                    int threads);

} // namespace pcl::cosection
