// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "galerkin_level.h"
#include "hessian_rows.h"

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
  MultigridPreconditioner (const Eigen::Vector3i& dims, double alpha, int smoothing_degree, int threads)
      : hessian_ (dims, threads)
      , alpha_ (static_cast<Real> (alpha))
      , degree_ (smoothing_degree)
      , threads_ (hessian_.threads ())
  {
    std::array<GalerkinAxis, 3> axes{GalerkinAxis::finest (dims.x ()), GalerkinAxis::finest (dims.y ()),
                                     GalerkinAxis::finest (dims.z ())};
    Eigen::Vector3i fine = dims;
    std::array<int, 3> span{0, 0, 0};
    do
    {
      const GridTransfer transfer (fine, coarsest_axis);
      for (int a = 0; a < 3; ++a)
        axes[a] = axes[a].coarsen (transfer.axes[a]);
      levels_.push_back (Level{transfer, GalerkinLevel<Real> (axes, alpha, threads), {}, {}, GuardedField<Real> ()});
      Level& level = levels_.back ();
      level.op.weights.allocate (transfer, span);
      level.op.setLargestEigenvalue (ChebyshevSteps::safety * largestEigenvalue (axes));
      span = level.op.weights.span ();
      level.rhs.resize (level.op.size ());
      level.z = GuardedField<Real> (level.op.size ());
      level.d.resize (level.op.size ());
      fine = transfer.coarseDims ();
    } while (fine.maxCoeff () > coarsest_axis);
    visits_ = levels_.size () < deep_levels ? 2 : 3;
  }

  /** \brief Set w: packed, one per voxel (see kernels::packWeight); kept by reference until the next call. */
  void setWeights (const std::uint16_t* weights)
  {
    weights_ = weights;
    for (std::size_t l = 0; l < levels_.size (); ++l)
    {
      auto& op = levels_[l].op;
      if (l == 0)
        op.weights.coarsen (levels_[l].transfer, weights, threads_);
      else
        op.weights.coarsen (levels_[l].transfer, levels_[l - 1].op.weights, op.threads ());
      op.updateDiagonal ();
    }
    factorizeCoarsest ();
  }

  /** \brief z = V-cycle (rhs) from zero. \param d scratch, one value per voxel */
  void apply (const Real* rhs, Real* z, Real* d)
  {
    smoothFinest (rhs, z, d, true);
    hessian_.forEachRow (z, [&] (int j, int k, const Real* product) {
      const std::size_t at = rowBegin (j, k);
      kernels::residualRow (rhs + at, product, weights_ + at, z + at, alpha_, hessian_.dims ().x (), d + at);
    });
    levels_[0].transfer.restrict(d, levels_[0].rhs.data (), threads_);
    cycle (0, true);
    levels_[0].transfer.prolongAdd (levels_[0].z.data (), z, threads_);
    smoothFinest (rhs, z, d, false);
  }

  const HessianOperator<Real>& hessian () const { return hessian_; }

private:
  static constexpr double largest_eigenvalue_finest = 144.0 / 42.0 * ChebyshevSteps::safety; // of D^-1 H^T H inside
  static constexpr int coarsest_axis = 4; // axes are halved down to this many voxels
  static constexpr std::size_t deep_levels = 6;

  struct Level
  {
    GridTransfer transfer; // from the level above
    GalerkinLevel<Real> op;
    std::vector<Real> rhs, d;
    GuardedField<Real> z;
  };

  /** \brief Largest eigenvalue of D^-1 R for the regulariser R of a coarse level. It depends on the border, where
   * interpolation extrapolates; a few voxels between the borders suffice. */
  static double largestEigenvalue (const std::array<GalerkinAxis, 3>& axes)
  {
    constexpr int probe_axis = 8;
    const std::array<GalerkinAxis, 3> probe{axes[0].shortened (probe_axis), axes[1].shortened (probe_axis),
                                            axes[2].shortened (probe_axis)};
    return GalerkinLevel<double> (probe, 1.0, 1).estimateLargestEigenvalue ();
  }

  void factorizeCoarsest ()
  {
    const GalerkinLevel<Real>& op = levels_.back ().op;
    const int n = static_cast<int> (op.size ());
    Eigen::MatrixXd coarsest (n, n);
    GuardedField<Real> unit (n);
    for (int column = 0; column < n; ++column)
    {
      unit[column] = Real (1);
      op.forEachRow (unit.data (), [&] (std::size_t at, const Real* values) {
        for (int i = 0; i < op.dims ().x (); ++i)
          coarsest (at + i, column) = values[i];
      });
      unit[column] = Real (0);
    }
    // Fields that neither data nor a bound determines (no data at all, say) must not divide by zero.
    coarsest.diagonal ().array () += 1e-9 * coarsest.diagonal ().maxCoeff () + 1e-30;
    factorization_.compute (coarsest);
  }

  /** \brief Index of the first voxel of a row on the finest level. */
  std::size_t rowBegin (int j, int k) const
  {
    return (static_cast<std::size_t> (k) * hessian_.dims ().y () + j) * hessian_.dims ().x ();
  }

  void smoothFinest (const Real* rhs, Real* z, Real* d, bool from_zero) const
  {
    const ChebyshevSteps steps{largest_eigenvalue_finest};
    const Eigen::Vector3i& dims = hessian_.dims ();
    const int nx = dims.x ();
    const std::size_t plane = static_cast<std::size_t> (nx) * dims.y ();
    for (int s = 0; s < degree_; ++s)
    {
      const Real step = static_cast<Real> (steps.step (s));
      const Real momentum = static_cast<Real> (steps.momentum (s));
      const auto update = [&] (int j, int k, const Real* product) {
        const std::size_t at = rowBegin (j, k);
        kernels::chebyshevRow (rhs + at, product, weights_ + at, z + at, hessian_.diagonal (j, k), alpha_, momentum,
                               step, nx, d + at);
      };
      const auto advance = [&] (int k) { kernels::addRow (d + k * plane, static_cast<int> (plane), z + k * plane); };
      if (s == 0)
        parallelFor (0, dims.z (), threads_, [&] (int k) {
          std::fill_n (d + k * plane, plane, Real (0));
          if (!from_zero)
            return;
          std::fill_n (z + k * plane, plane, Real (0));
          const std::vector<Real> zero (nx, Real (0));
          for (int j = 0; j < dims.y (); ++j)
            update (j, k, zero.data ());
          advance (k);
        });
      if (s > 0 || !from_zero)
        hessian_.forEachRow (z, update, advance);
    }
  }

  /** \brief One cycle on the z of a coarse level, which is taken as zero if \a from_zero. */
  void cycle (std::size_t l, bool from_zero)
  {
    Level& level = levels_[l];
    if (l + 1 == levels_.size ())
    {
      using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
      const Eigen::VectorXd rhs = Eigen::Map<const Vector> (level.rhs.data (), level.rhs.size ())
                                      .template cast<double> ();
      Eigen::Map<Vector> (level.z.data (), level.z.size ()) = factorization_.solve (rhs).template cast<Real> ();
      return;
    }
    Level& coarse = levels_[l + 1];
    level.op.smooth (level.rhs.data (), level.z.data (), level.d.data (), degree_, from_zero);
    level.op.forEachRow (level.z.data (), [&] (std::size_t at, const Real* product) {
      for (int i = 0; i < level.op.dims ().x (); ++i)
        level.d[at + i] = level.rhs[at + i] - product[i];
    });
    coarse.transfer.restrict(level.d.data (), coarse.rhs.data (), level.op.threads ());
    const bool solved_at_once = l + 2 == levels_.size ();
    cycle (l + 1, true);
    for (int visit = 1; !solved_at_once && visit < visits_; ++visit)
      cycle (l + 1, false);
    coarse.transfer.prolongAdd (coarse.z.data (), level.z.data (), level.op.threads ());
    level.op.smooth (level.rhs.data (), level.z.data (), level.d.data (), degree_, false);
  }

  HessianOperator<Real> hessian_;
  Real alpha_;
  int degree_;
  int threads_;
  int visits_; // of the next level, from a coarse one
  const std::uint16_t* weights_ = nullptr;
  std::vector<Level> levels_; // coarse ones, finer first
  Eigen::LDLT<Eigen::MatrixXd> factorization_;
};

} // namespace pcl::cosection
