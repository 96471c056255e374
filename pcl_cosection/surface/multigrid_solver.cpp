// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "energy.h"
#include "hessian_rows.h"
#include "multigrid_preconditioner.h"
#include "solver_detail.h"

#include <algorithm>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

template <typename Real> class NewtonMultigrid
{
public:
  NewtonMultigrid (const EnergyProblem& problem, const SolverOptions& options, std::vector<Real>& u)
  : problem_ (problem)
  , threads_ (threadsForVoxels (options.threads, problem.size ()))
  , preconditioner_ (problem.dims, problem.alpha, options.smoothing_degree, options.threads)
  , u_ (u)
  , residual_ (u.size ())
  , direction_ (u.size ())
  , z_ (u.size ())
  , scratch_ (u.size ())
  , weights_ (u.size ())
  {}

  /** \brief E at the current u; refreshes residual and active set. */
  double
  linearize ()
  {
    return evaluate (problem_, preconditioner_.hessian (), u_.data (), residual_.data (), weights_.data ());
  }

  /** \brief One iteration; returns the largest change where |u| < band. */
  double
  step (double band)
  {
    preconditioner_.setWeights (weights_.data ());
    preconditioner_.apply (residual_.data (), z_.data (), scratch_.data ());
    combine ();
    const double t = lineSearch ();
    return advance (t, band);
  }

private:
  std::size_t
  plane () const
  {
    return static_cast<std::size_t> (problem_.dims.x ()) * problem_.dims.y ();
  }

  /** \brief direction = z + factor direction, the minimiser of the local quadratic model over both. */
  void
  combine ()
  {
    const int nx = problem_.dims.x ();
    const int ny = problem_.dims.y ();
    std::vector<kernels::DirectionProducts> planes (problem_.dims.z ()); // a plane is one thread's, row after row
    preconditioner_.hessian ().forEachRow (z_.data (), [&] (int j, int k, const Real* h) {
      const std::size_t at = (static_cast<std::size_t> (k) * ny + j) * nx;
      planes[k] += kernels::directionRow (problem_.weight.data () + at, weights_.data () + at, residual_.data () + at, h,
                                         z_.data () + at, direction_.data () + at, static_cast<Real> (problem_.alpha), nx);
    });
    kernels::DirectionProducts s;
    for (const kernels::DirectionProducts& plane_products : planes)
      s += plane_products;
    double factor = 0.0;
    if (curvature_ > 0.0)
    {
      const double zz = s.z_S_z + s.z_A_z;
      const double zp = s.z_S_p + s.z_A_p;
      const double pp = curvature_ + s.p_A_p;
      // Minimise over a z + b p and normalise to z + (b / a) p.
      const double determinant = zz * pp - zp * zp;
      const double a = s.r_z * pp - s.r_p * zp;
      const double b = s.r_p * zz - s.r_z * zp;
      if (determinant > 1e-12 * zz * pp && a > 0.0)
        factor = b / a;
    }
    curvature_ = std::max (0.0, s.z_S_z + 2.0 * factor * s.z_S_p + factor * factor * curvature_);
    descent_ = s.r_z + factor * s.r_p;
    parallelFor (0, problem_.dims.z (), threads_, [&] (int k) {
      kernels::scaleAddRow (z_.data () + k * plane (), static_cast<Real> (factor), static_cast<int> (plane ()),
                            direction_.data () + k * plane ());
    });
  }

  /** \brief Minimiser of E (u + t direction): its derivative is piecewise linear and increasing. */
  double
  lineSearch () const
  {
    if (!(descent_ > 0.0))
      return 0.0;
    const double smooth_slope = -descent_ - boundDerivatives (problem_, u_.data (), direction_.data (), 0.0, threads_).slope;
    double low = 0.0;
    double high = 0.0; // 0: not bracketed yet
    double t = 1.0;
    constexpr int max_evaluations = 12;
    constexpr double slope_reduction = 1e-3;
    for (int i = 0; i < max_evaluations; ++i)
    {
      const LineDerivatives bounds = boundDerivatives (problem_, u_.data (), direction_.data (), t, threads_);
      const double slope = smooth_slope + t * curvature_ + bounds.slope;
      if (std::abs (slope) <= slope_reduction * descent_)
        return t;
      (slope < 0.0 ? low : high) = t;
      const double curvature = curvature_ + bounds.curvature;
      const double newton = curvature > 0.0 ? t - slope / curvature : 2.0 * t;
      if (high > 0.0)
        t = newton > low && newton < high ? newton : 0.5 * (low + high);
      else
        t = std::min (newton, 8.0 * t);
    }
    return low; // E still falls up to here
  }

  double
  advance (double t, double band)
  {
    std::vector<double> largest (problem_.dims.z (), 0.0);
    parallelFor (0, problem_.dims.z (), threads_, [&] (int k) {
      largest[k] = kernels::advanceRow (direction_.data () + k * plane (), static_cast<Real> (t), static_cast<Real> (band),
                                        static_cast<int> (plane ()), u_.data () + k * plane ());
    });
    return *std::max_element (largest.begin (), largest.end ());
  }

  const EnergyProblem& problem_;
  int threads_;
  MultigridPreconditioner<Real> preconditioner_;
  std::vector<Real>& u_;
  std::vector<Real> residual_, direction_, z_, scratch_;
  std::vector<std::uint16_t> weights_;
  double curvature_ = 0.0; // of half the smooth energy along the direction
  double descent_ = 0.0;   // residual . direction
};

} // namespace

template <typename Real> SolverSummary
solveLevelMultigrid (const EnergyProblem& problem, const SolverOptions& options, double band, double tolerance,
                     std::vector<Real>& u, const ProgressCallback& progress)
{
  SolverSummary summary;
  NewtonMultigrid<Real> newton (problem, options, u);
  constexpr double tiny_change = 0.2;
  bool was_small = false;
  double energy = newton.linearize ();
  summary.energies.push_back (energy);
  for (int i = 0; i < options.max_iterations; ++i)
  {
    report (progress, static_cast<double> (i) / options.max_iterations);
    summary.change_vox = newton.step (band);
    energy = newton.linearize ();
    summary.energies.push_back (energy);
    ++summary.iterations;
    // One small step may be a short one; two in a row, or a tiny one, are the end.
    const bool small = summary.change_vox < tolerance;
    if ((small && was_small) || summary.change_vox < tiny_change * tolerance)
    {
      summary.termination = Termination::Converged;
      break;
    }
    was_small = small;
  }
  summary.energy = energy;
  return summary;
}

template SolverSummary
solveLevelMultigrid<float> (const EnergyProblem&, const SolverOptions&, double, double, std::vector<float>&,
                            const ProgressCallback&);
template SolverSummary
solveLevelMultigrid<double> (const EnergyProblem&, const SolverOptions&, double, double, std::vector<double>&,
                             const ProgressCallback&);

} // namespace cosection
} // namespace pcl
