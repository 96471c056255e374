// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "energy.h"
#include "hessian_rows.h"
#include "multigrid_preconditioner.h"
#include "solver_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double blocked_step = 0.3;     // a direction whose best step is shorter ran into inactive bounds
constexpr double slope_reduction = 1e-3; // of the line search
constexpr double expected_rate = 0.5;    // assumed ratio of successive changes after the first step
constexpr double largest_rate = 0.95;

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
  double linearize ()
  {
    return evaluate (problem_, preconditioner_.hessian (), u_.data (), residual_.data (), weights_.data ());
  }

  struct Step
  {
    kernels::SquaredChange change; ///< where |u| < band
    bool blocked = false;
  };

  /** \brief One iteration. */
  Step step (double band)
  {
    preconditioner_.setWeights (weights_.data ());
    preconditioner_.apply (residual_.data (), z_.data (), scratch_.data ());
    combine ();
    double t = lineSearch ();
    const bool was_predicted = predicted_;
    const bool descends = descent_ > 0.0; // otherwise u is the minimiser up to rounding
    predicted_ = descends && t < blocked_step && !was_predicted;
    if (predicted_)
      t = stepWithPredictedBounds ();
    return {advance (t, band), descends && t < blocked_step};
  }

private:
  /** \brief The direction ran into inactive bounds: find a new one with the bounds active that it would violate, as in
   * a primal-dual active set method. Returns the step along it. */
  double stepWithPredictedBounds ()
  {
    predictActiveSet (problem_, u_.data (), direction_.data (), residual_.data (), weights_.data (), threads_);
    preconditioner_.setWeights (weights_.data ());
    preconditioner_.apply (residual_.data (), z_.data (), scratch_.data ());
    linearize ();
    curvature_ = 0.0; // the direction is new
    combine ();
    return lineSearch ();
  }

  std::size_t plane () const { return static_cast<std::size_t> (problem_.dims.x ()) * problem_.dims.y (); }

  /** \brief direction = z + factor direction, the minimiser of the local quadratic model over both. */
  void combine ()
  {
    const int nx = problem_.dims.x ();
    const int ny = problem_.dims.y ();
    std::vector<kernels::DirectionProducts> planes (problem_.dims.z ()); // each plane is summed by one thread
    preconditioner_.hessian ().forEachRow (z_.data (), [&] (int j, int k, const Real* h) {
      const std::size_t at = (static_cast<std::size_t> (k) * ny + j) * nx;
      planes[k] += kernels::directionRow (problem_.weight.data () + at, weights_.data () + at, residual_.data () + at,
                                          h, z_.data () + at, direction_.data () + at,
                                          static_cast<Real> (problem_.alpha), nx);
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

  /** \brief Minimiser of E (u + t direction): its derivative is piecewise linear and increasing. Two places
   * are tried in each pass over the bounds. */
  double lineSearch () const
  {
    if (!(descent_ > 0.0))
      return 0.0;
    constexpr int max_passes = 8;
    double low = 0.0;
    double low_slope = -descent_;
    double high = 0.0; // 0: not bracketed yet
    double high_slope = 0.0;
    double t_1 = 0.0;
    double t_2 = 1.0;
    double smooth_slope = 0.0; // at u
    for (int pass = 0; pass < max_passes; ++pass)
    {
      const kernels::LinePair bounds = boundDerivatives (problem_, u_.data (), direction_.data (), t_1, t_2, threads_);
      if (pass == 0)
        smooth_slope = -descent_ - bounds.first.slope;
      double nearest = 0.0; // of the two places to the minimum
      double newton = 0.0;  // from there
      double smallest = std::numeric_limits<double>::infinity ();
      const auto look = [&] (double t, const kernels::LineDerivatives& of_bounds) {
        const double slope = smooth_slope + t * curvature_ + of_bounds.slope;
        const double curvature = curvature_ + of_bounds.curvature;
        if (slope < 0.0 && t >= low)
        {
          low = t;
          low_slope = slope;
        }
        if (slope >= 0.0 && (high == 0.0 || t <= high))
        {
          high = t;
          high_slope = slope;
        }
        if (std::abs (slope) >= smallest)
          return;
        smallest = std::abs (slope);
        nearest = t;
        newton = curvature > 0.0 ? t - slope / curvature : 2.0 * t;
      };
      if (pass > 0)
        look (t_1, bounds.first);
      look (t_2, bounds.second);
      if (smallest <= slope_reduction * descent_)
        return nearest;
      if (high == 0.0)
      {
        t_1 = std::min (newton, 8.0 * low);
        t_2 = 2.0 * t_1;
        continue;
      }
      const double secant = low - low_slope * (high - low) / (high_slope - low_slope);
      t_1 = newton > low && newton < high ? newton : 0.5 * (low + high);
      t_2 = secant != t_1 ? secant : 0.5 * (low + high);
    }
    return low; // E still falls up to here
  }

  kernels::SquaredChange advance (double t, double band)
  {
    std::vector<kernels::SquaredChange> planes (problem_.dims.z ());
    parallelFor (0, problem_.dims.z (), threads_, [&] (int k) {
      planes[k] = kernels::advanceRow (direction_.data () + k * plane (), static_cast<Real> (t),
                                       static_cast<Real> (band), static_cast<int> (plane ()),
                                       u_.data () + k * plane ());
    });
    kernels::SquaredChange all;
    for (const kernels::SquaredChange& of_plane : planes)
      all += of_plane;
    return all;
  }

  const EnergyProblem& problem_;
  int threads_;
  MultigridPreconditioner<Real> preconditioner_;
  std::vector<Real>& u_;
  std::vector<Real> residual_, direction_, z_, scratch_;
  std::vector<std::uint16_t> weights_;
  bool predicted_ = false; // the last step was taken with predicted bounds
  double curvature_ = 0.0; // of half the smooth energy along the direction
  double descent_ = 0.0;   // residual . direction
};

} // namespace

template <typename Real>
SolverSummary
solveLevelMultigrid (const EnergyProblem& problem, const SolverOptions& options, const LevelTolerance& tolerance,
                     std::vector<Real>& u, const ProgressCallback& progress)
{
  SolverSummary summary;
  NewtonMultigrid<Real> newton (problem, options, u);
  double energy = newton.linearize ();
  summary.energies.push_back (energy);
  for (int i = 0; i < options.max_iterations; ++i)
  {
    report (progress, static_cast<double> (i) / options.max_iterations);
    const double last_change = summary.change_vox;
    const auto step = newton.step (tolerance.band);
    energy = newton.linearize ();
    summary.change_vox = step.change.rootMean ();
    summary.energies.push_back (energy);
    ++summary.iterations;
    // Changes fall geometrically; the sum of the remaining ones is the error.
    const double rate = i == 0 ? expected_rate
                               : std::min (largest_rate, summary.change_vox / std::max (last_change, 1e-30));
    if (!step.blocked && tolerance.met (step.change, std::max (1.0, rate / (1.0 - rate))))
    {
      summary.termination = Termination::Converged;
      break;
    }
  }
  summary.energy = energy;
  return summary;
}

template SolverSummary solveLevelMultigrid<float> (const EnergyProblem&, const SolverOptions&, const LevelTolerance&,
                                                   std::vector<float>&, const ProgressCallback&);
template SolverSummary solveLevelMultigrid<double> (const EnergyProblem&, const SolverOptions&, const LevelTolerance&,
                                                    std::vector<double>&, const ProgressCallback&);

} // namespace pcl::cosection
