// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "multigrid_preconditioner.h"

#include "chebyshev.h"
#include "hessian_rows.h"

namespace pcl::cosection {
namespace {

constexpr double largest_eigenvalue_finest = 144.0 / 42.0 * chebyshev_safety; // of D^-1 H^T H in the interior

constexpr int coarsest_axis = 4; // axes are halved down to this many voxels
constexpr std::size_t deep_levels = 6;

/** \brief Largest eigenvalue of D^-1 R for the regulariser R of a coarse level. It depends on the border, where
 * interpolation extrapolates; a few voxels between the borders suffice. */
double
largestEigenvalue (const std::array<GalerkinAxis, 3>& axes)
{
  constexpr int probe_axis = 8;
  const std::array<GalerkinAxis, 3> probe{axes[0].shortened (probe_axis), axes[1].shortened (probe_axis),
                                          axes[2].shortened (probe_axis)};
  return GalerkinLevel<double> (probe, 1.0, 1).estimateLargestEigenvalue ();
}

} // namespace

template <typename Real>
MultigridPreconditioner<Real>::MultigridPreconditioner (const Eigen::Vector3i& dims, double alpha, int smoothing_degree,
                                                        int threads)
    : hessian_ (dims, threads)
    , alpha_ (alpha)
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
    level.op.setLargestEigenvalue (chebyshev_safety * largestEigenvalue (axes));
    span = level.op.weights.span;
    level.rhs.resize (level.op.size ());
    level.z = GuardedField<Real> (level.op.size ());
    level.d.resize (level.op.size ());
    fine = transfer.coarseDims ();
  } while (fine.maxCoeff () > coarsest_axis);
  visits_ = levels_.size () < deep_levels ? 2 : 3;
}

template <typename Real>
void
MultigridPreconditioner<Real>::setWeights (const std::uint16_t* weights)
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

template <typename Real>
void
MultigridPreconditioner<Real>::factorizeCoarsest ()
{
  Level& level = levels_.back ();
  const int n = static_cast<int> (level.op.size ());
  const int nx = level.op.dims ().x ();
  const int ny = level.op.dims ().y ();
  coarsest_.resize (n, n);
  GuardedField<Real> unit (n);
  for (int column = 0; column < n; ++column)
  {
    unit[column] = Real (1);
    level.op.forEachRow (unit.data (), [&] (int j, int k, const Real* values) {
      for (int i = 0; i < nx; ++i)
        coarsest_ ((k * ny + j) * nx + i, column) = values[i];
    });
    unit[column] = Real (0);
  }
  // Fields that neither data nor a bound determines (no data at all, say) must not divide by zero.
  coarsest_.diagonal ().array () += 1e-9 * coarsest_.diagonal ().maxCoeff () + 1e-30;
  factorization_.compute (coarsest_);
}

template <typename Real>
void
MultigridPreconditioner<Real>::smoothFinest (const Real* rhs, Real* z, Real* d, bool from_zero) const
{
  const ChebyshevSteps steps (degree_, largest_eigenvalue_finest);
  const Eigen::Vector3i& dims = hessian_.dims ();
  const int nx = dims.x ();
  const std::size_t plane = static_cast<std::size_t> (nx) * dims.y ();
  for (int s = 0; s < degree_; ++s)
  {
    const Real alpha = static_cast<Real> (alpha_);
    const Real step = static_cast<Real> (steps.step (s));
    const Real momentum = s == 0 ? Real (0) : static_cast<Real> (steps.momentum (s));
    const auto update = [&] (int j, int k, const Real* product) {
      const std::size_t offset = k * plane + static_cast<std::size_t> (j) * nx;
      kernels::chebyshevRow (rhs + offset, product, weights_ + offset, z + offset, hessian_.diagonal (j, k), alpha,
                             momentum, step, nx, d + offset);
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

template <typename Real>
void
MultigridPreconditioner<Real>::restrictResidual (const Real* rhs, const Real* z, Real* d)
{
  const Eigen::Vector3i& dims = hessian_.dims ();
  hessian_.forEachRow (z, [&] (int j, int k, const Real* product) {
    const std::size_t offset = (static_cast<std::size_t> (k) * dims.y () + j) * dims.x ();
    kernels::residualRow (rhs + offset, product, weights_ + offset, z + offset, static_cast<Real> (alpha_), dims.x (),
                          d + offset);
  });
  levels_[0].transfer.restrict(d, levels_[0].rhs.data (), threads_);
}

template <typename Real>
void
MultigridPreconditioner<Real>::cycle (std::size_t l, bool from_zero)
{
  Level& level = levels_[l];
  if (l + 1 == levels_.size ())
  {
    const Eigen::VectorXd rhs = Eigen::Map<const Eigen::Matrix<Real, Eigen::Dynamic, 1>> (level.rhs.data (),
                                                                                          level.rhs.size ())
                                    .template cast<double> ();
    Eigen::Map<Eigen::Matrix<Real, Eigen::Dynamic, 1>> (
        level.z.data (), level.z.size ()) = factorization_.solve (rhs).template cast<Real> ();
    return;
  }
  Level& coarse = levels_[l + 1];
  level.op.smooth (level.rhs.data (), level.z.data (), level.d.data (), degree_, from_zero);
  level.op.forEachRow (level.z.data (), [&] (int j, int k, const Real* product) {
    const std::size_t offset = (static_cast<std::size_t> (k) * level.op.dims ().y () + j) * level.op.dims ().x ();
    for (int i = 0; i < level.op.dims ().x (); ++i)
      level.d[offset + i] = level.rhs[offset + i] - product[i];
  });
  coarse.transfer.restrict(level.d.data (), coarse.rhs.data (), level.op.threads ());
  const bool solved_at_once = l + 2 == levels_.size ();
  cycle (l + 1, true);
  for (int visit = 1; !solved_at_once && visit < visits_; ++visit)
    cycle (l + 1, false);
  coarse.transfer.prolongAdd (coarse.z.data (), level.z.data (), level.op.threads ());
  level.op.smooth (level.rhs.data (), level.z.data (), level.d.data (), degree_, false);
}

template <typename Real>
void
MultigridPreconditioner<Real>::apply (const Real* rhs, Real* z, Real* d)
{
  smoothFinest (rhs, z, d, true);
  restrictResidual (rhs, z, d);
  cycle (0, true);
  levels_[0].transfer.prolongAdd (levels_[0].z.data (), z, threads_);
  smoothFinest (rhs, z, d, false);
}

template class MultigridPreconditioner<float>;
template class MultigridPreconditioner<double>;

} // namespace pcl::cosection
