// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "galerkin_level.h"

#include "hessian_operator.h"

#include <Eigen/Cholesky>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief One symmetric multigrid cycle for (alpha H^T H + diag (w)) z = rhs: Chebyshev smoothing, linear
 * interpolation and its transpose, exact Galerkin operators on the coarse levels, a Cholesky
 * factorisation on the coarsest.
 *
 * It is a V-cycle on the finest level; below, each level visits the next two times (W-cycle), in deep
 * hierarchies three. The data are a thin band of large w, which fixes the coarse functions near it: a coarse problem
 * then removes only a part of the smooth error of the next finer level, a smaller part the coarser it is. Further
 * visits, where they are cheap, make up for it. */
template <typename Real> class MultigridPreconditioner
{
public:
  MultigridPreconditioner (const Eigen::Vector3i& dims, double alpha, int smoothing_degree, int threads);

  /** \brief Set w: packed, one per voxel (see kernels::packWeight); kept by reference until the next call. */
  void setWeights (const std::uint16_t* weights);

  /** \brief z = V-cycle (rhs) from zero. \param d scratch, one value per voxel */
  void apply (const Real* rhs, Real* z, Real* d);

  const HessianOperator<Real>& hessian () const { return hessian_; }

private:
  struct Level
  {
    GridTransfer transfer; // from the level above
    GalerkinLevel<Real> op;
    std::vector<Real> rhs, d;
    GuardedField<Real> z;
  };

  void smoothFinest (const Real* rhs, Real* z, Real* d, bool from_zero) const;
  void restrictResidual (const Real* rhs, const Real* z, Real* d);
  /** \brief One cycle on the z of a coarse level, which is taken as zero if \a from_zero. */
  void cycle (std::size_t level, bool from_zero);
  void factorizeCoarsest ();

  HessianOperator<Real> hessian_;
  double alpha_;
  int degree_;
  int threads_;
  int visits_ = 2; // of the next level, from a coarse one
  const std::uint16_t* weights_ = nullptr;
  std::vector<Level> levels_; // coarse ones, finer first
  Eigen::MatrixXd coarsest_;
  Eigen::LDLT<Eigen::MatrixXd> factorization_;
};

} // namespace pcl::cosection
