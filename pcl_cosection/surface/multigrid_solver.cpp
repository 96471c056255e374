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

/** \brief Quantities of a search direction with respect to the quadratic part of half the energy. */
struct Products
{
  double zz = 0.0; // z . S z, S = W + alpha H^T H
  double zp = 0.0; // z . S p
};

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

  template <typename Function> double
  sum (Function&& f) const
  {
    return sumOverPlanes (problem_.dims.z (), threads_, [&] (int k) {
      double s = 0.0;
      for (std::size_t n = k * plane (); n < (k + 1) * plane (); ++n)
        s += f (n);
      return s;
    });
  }

  /** \brief direction = z + beta * direction, the minimiser of the local quadratic model over both. */
  void
  combine ()
  {
    const int nx = problem_.dims.x ();
    const int ny = problem_.dims.y ();
    const Real alpha = static_cast<Real> (problem_.alpha);
    std::vector<Products> rows (static_cast<std::size_t> (ny) * problem_.dims.z ());
    preconditioner_.hessian ().forEachRow (z_.data (), [&] (int j, int k, const Real* h) {
      const std::size_t row = static_cast<std::size_t> (k) * ny + j;
      Products s;
      for (int i = 0; i < nx; ++i)
      {
        const std::size_t n = row * nx + i;
        const double product = alpha * h[i] + static_cast<Real> (problem_.weight[n]) * z_[n];
        s.zz += product * z_[n];
        s.zp += product * direction_[n];
      }
      rows[row] = s;
    });
    Products smooth;
    for (const Products& s : rows)
    {
      smooth.zz += s.zz;
      smooth.zp += s.zp;
    }
    double factor = 0.0;
    if (curvature_ > 0.0)
    {
      const auto active = [&] (std::size_t n) {
        return static_cast<double> (kernels::unpackWeight (weights_[n])) - problem_.weight[n];
      };
      const double zz = smooth.zz + sum ([&] (std::size_t n) { return active (n) * z_[n] * z_[n]; });
      const double zp = smooth.zp + sum ([&] (std::size_t n) { return active (n) * z_[n] * direction_[n]; });
      const double pp = curvature_ + sum ([&] (std::size_t n) { return active (n) * direction_[n] * direction_[n]; });
      const double rz = sum ([&] (std::size_t n) { return static_cast<double> (residual_[n]) * z_[n]; });
      const double rp = sum ([&] (std::size_t n) { return static_cast<double> (residual_[n]) * direction_[n]; });
      // Minimise over a z + b p and normalise to z + (b / a) p.
      const double determinant = zz * pp - zp * zp;
      const double a = rz * pp - rp * zp;
      const double b = rp * zz - rz * zp;
      if (determinant > 1e-12 * zz * pp && a > 0.0)
        factor = b / a;
    }
    curvature_ = std::max (0.0, smooth.zz + 2.0 * factor * smooth.zp + factor * factor * curvature_);
    parallelFor (0, problem_.dims.z (), threads_, [&] (int k) {
      kernels::scaleAddRow (z_.data () + k * plane (), static_cast<Real> (factor), static_cast<int> (plane ()),
                            direction_.data () + k * plane ());
    });
  }

  /** \brief Minimiser of E (u + t direction): its derivative is piecewise linear and increasing. */
  double
  lineSearch () const
  {
    const double descent = sum ([&] (std::size_t n) { return static_cast<double> (residual_[n]) * direction_[n]; });
    if (!(descent > 0.0))
      return 0.0;
    const double smooth_slope = -descent - boundDerivatives (problem_, u_.data (), direction_.data (), 0.0, threads_).slope;
    double low = 0.0;
    double high = 0.0; // 0: not bracketed yet
    double t = 1.0;
    constexpr int max_evaluations = 12;
    for (int i = 0; i < max_evaluations; ++i)
    {
      const LineDerivatives bounds = boundDerivatives (problem_, u_.data (), direction_.data (), t, threads_);
      const double slope = smooth_slope + t * curvature_ + bounds.slope;
      if (std::abs (slope) <= 1e-3 * descent)
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
    const Real step = static_cast<Real> (t);
    std::vector<double> largest (problem_.dims.z (), 0.0);
    parallelFor (0, problem_.dims.z (), threads_, [&] (int k) {
      Real change = 0;
      for (std::size_t n = k * plane (); n < (k + 1) * plane (); ++n)
      {
        const Real before = u_[n];
        u_[n] += step * direction_[n];
        if (std::min (std::abs (before), std::abs (u_[n])) < static_cast<Real> (band))
          change = std::max (change, std::abs (step * direction_[n]));
      }
      largest[k] = change;
    });
    return *std::max_element (largest.begin (), largest.end ());
  }

  const EnergyProblem& problem_;
  int threads_;
  MultigridPreconditioner<Real> preconditioner_;
  std::vector<Real>& u_;
  std::vector<Real> residual_, direction_, z_, scratch_;
  std::vector<std::uint16_t> weights_;
  double curvature_ = 0.0; // direction . S direction
};

} // namespace

template <typename Real> SolverSummary
solveLevelMultigrid (const EnergyProblem& problem, const SolverOptions& options, double band, double tolerance,
                     std::vector<Real>& u, const ProgressCallback& progress)
{
  SolverSummary summary;
  NewtonMultigrid<Real> newton (problem, options, u);
  double energy = newton.linearize ();
  summary.energies.push_back (energy);
  for (int i = 0; i < options.max_iterations; ++i)
  {
    report (progress, static_cast<double> (i) / options.max_iterations);
    summary.change_vox = newton.step (band);
    energy = newton.linearize ();
    summary.energies.push_back (energy);
    ++summary.iterations;
    if (summary.change_vox < tolerance)
    {
      summary.termination = Termination::Converged;
      break;
    }
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
