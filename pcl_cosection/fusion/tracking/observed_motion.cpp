// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "observed_motion.h"

#include "pcl_cosection/common/quantile.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double significance = 3.0; // standard deviations
constexpr double least_sigma = 1e-4; // metres

/** \brief Standard deviation of the distance of a point of weight 1, from the median. */
double
spread (const std::vector<SurfaceSample>& samples)
{
  std::vector<double> sizes (samples.size ());
  std::transform (samples.begin (), samples.end (), sizes.begin (), [] (const SurfaceSample& sample) {
    return std::abs (sample.distance) * std::sqrt (sample.weight / sample.points);
  });
  return sigmaOfSizes (sizes);
}

} // namespace

ObservedMotion
observedMotion (const std::vector<SurfaceSample>& samples, const Eigen::Isometry3d& guess,
                const Eigen::Isometry3d& found, const MotionPrior& prior)
{
  ObservedMotion result;
  result.T_model_camera = guess;
  if (samples.empty ())
    return result;
  const MotionChart chart (samples);
  double total = 0.0;
  Matrix6d curvature = Matrix6d::Zero ();
  for (const SurfaceSample& sample : samples)
  {
    const Vector6d slope = chart.slope (sample);
    curvature += sample.weight * slope * slope.transpose ();
    total += sample.weight;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (curvature);
  const double sigma = spread (samples);

  Vector6d moved = chart.coordinates (found * guess.inverse ());
  Matrix6d held_directions = Matrix6d::Zero ();
  int held_count = 0;
  for (int k = 0; k < 6; ++k)
  {
    const Vector6d direction = solver.eigenvectors ().col (k);
    const double along = direction.dot (moved);
    const bool observed = directionSupport (samples, chart, direction).isEnough (total);
    const double variance = sigma * sigma * prior.correlated / solver.eigenvalues ()[k];
    const bool significant = along * along >= significance * significance * variance;
    result.directions += observed;
    if (observed)
      result.precision += solver.eigenvalues ()[k] / std::max (sigma * sigma, least_sigma * least_sigma) * direction *
                          direction.transpose ();
    if (!observed || !significant)
      held_directions.col (held_count++) = direction;
  }
  if (held_count == 0)
  {
    result.T_model_camera = found;
    return result;
  }
  // The cheapest of all motions that differ in these directions only.
  Vector6d costs = Vector6d::Ones ();
  costs.tail<3> ().setConstant (prior.cost_of_turns);
  const auto free = held_directions.leftCols (held_count);
  moved -= free * (costs.asDiagonal () * free).colPivHouseholderQr ().solve (costs.cwiseProduct (moved));
  result.T_model_camera = chart.motion (moved) * guess;
  return result;
}

} // namespace pcl::cosection
