// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "observed_motion.h"

#include "pcl_cosection/common/quantile.h"

#include <pcl/cosection/common/camera.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double least_slope = 0.3;    // of the distance: smaller ones are where it is truncated
constexpr double least_facing = 0.5;   // of the slope, along a direction that a sample observes
constexpr double significant = 2.5;    // standard deviations of a slope: rare by chance
constexpr float settled_weight = 4.0f; // of voxels
constexpr double slope_error = 0.2;    // standard deviation
constexpr double cell_reach_vox = 0.5; // of a cell's own slope
constexpr double largest_reach_vox = 4.0;
constexpr double least_share = 0.005;         // of the samples' weight that observes a direction
constexpr double least_settled_share = 0.001; // the same of settled samples: distances are less noisy there
constexpr double significance = 3.0;          // standard deviations of a motion
constexpr double least_sigma = 1e-4;          // metres

/** \brief Gradient of the distance by central differences; nothing where one of them is not known. */
std::optional<Eigen::Vector3d>
slopeAround (const TsdfVolume& volume, const Eigen::Vector3d& p, double reach_vox)
{
  const double reach_m = reach_vox * volume.grid ().voxel_size_m;
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto before = volume.sample<double> (p - reach_m * Eigen::Vector3d::Unit (axis));
    const auto behind = volume.sample<double> (p + reach_m * Eigen::Vector3d::Unit (axis));
    if (!before || !behind)
      return std::nullopt;
    slope[axis] = (behind->value () - before->value ()) / (2.0 * reach_m);
  }
  return slope;
}

/** \brief Standard deviation of the slope over \a reach_vox to either side, of \a weight readings at depth \a z. */
double
slopeError (double z, float weight, double reach_vox, double voxel_size_m)
{
  return depthNoiseSigma (z) / (std::sqrt (2.0 * std::max (weight, 1e-6f)) * reach_vox * voxel_size_m);
}

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

std::vector<SurfaceSample>
sampleSurface (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights, const TsdfVolume& volume,
               const Eigen::Isometry3d& T_model_sensor, const SampleOptions& options)
{
  std::vector<SurfaceSample> samples;
  const std::size_t step = std::max<std::size_t> (1, points.size () / options.most_points);
  for (std::size_t n = 0; n < points.size (); n += step)
  {
    const Eigen::Vector3d p = T_model_sensor * points[n].cast<double> ();
    const auto cell = weights[n] > 0.0f ? volume.sample<double> (p) : std::nullopt;
    if (!cell)
      continue;
    const float seen = volume.weight (p);
    const double voxel_m = volume.grid ().voxel_size_m;
    double reach = options.reach_vox, facing = least_facing;
    if (options.smooth_noise)
    {
      reach = std::clamp (slopeError (points[n].z (), seen, 1.0, voxel_m) / slope_error, cell_reach_vox,
                          largest_reach_vox);
      facing = std::max (least_facing, significant * slopeError (points[n].z (), seen, reach, voxel_m));
    }
    const auto slope = reach <= cell_reach_vox ? std::optional<Eigen::Vector3d> (cell->gradient ())
                                               : slopeAround (volume, p, reach);
    if (!slope || slope->norm () < least_slope)
      continue;
    const double represented = static_cast<double> (step);
    samples.push_back ({p, slope->normalized (), represented, represented * weights[n], cell->value (), facing,
                        seen >= settled_weight});
  }
  return samples;
}

MotionChart::MotionChart (const std::vector<SurfaceSample>& samples)
{
  double total = 0.0;
  for (const SurfaceSample& sample : samples)
  {
    centre_ += sample.weight * sample.position;
    total += sample.weight;
  }
  if (!(total > 0.0))
    return;
  centre_ /= total;
  double squares = 0.0;
  for (const SurfaceSample& sample : samples)
    squares += sample.weight * (sample.position - centre_).squaredNorm ();
  radius_ = std::max (1e-6, std::sqrt (squares / total));
}

Vector6d
MotionChart::coordinates (const Eigen::Isometry3d& motion) const
{
  const Eigen::AngleAxisd turn (motion.linear ());
  Vector6d result;
  result << motion * centre_ - centre_, radius_ * turn.angle () * turn.axis ();
  return result;
}

Eigen::Isometry3d
MotionChart::motion (const Vector6d& coordinates) const
{
  const Eigen::Vector3d rotation = coordinates.tail<3> () / radius_;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity ();
  if (rotation.norm () > 0.0)
    result.linear () = Eigen::AngleAxisd (rotation.norm (), rotation.normalized ()).toRotationMatrix ();
  result.translation () = centre_ + coordinates.head<3> () - result.linear () * centre_;
  return result;
}

DirectionSupport
directionSupport (const std::vector<SurfaceSample>& samples, const MotionChart& chart, const Vector6d& direction)
{
  DirectionSupport support;
  for (const SurfaceSample& sample : samples)
  {
    const double along = chart.slope (sample).dot (direction);
    if (std::abs (along) < sample.facing)
      continue;
    support.all += sample.weight * along * along;
    support.settled += sample.settled ? sample.weight * along * along : 0.0;
  }
  return support;
}

std::vector<PrincipalDirection>
principalDirections (const std::vector<SurfaceSample>& samples, const MotionChart& chart)
{
  double total = 0.0;
  Matrix6d curvature = Matrix6d::Zero ();
  for (const SurfaceSample& sample : samples)
  {
    const Vector6d slope = chart.slope (sample);
    curvature += sample.weight * slope * slope.transpose ();
    total += sample.weight;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (curvature);
  std::vector<PrincipalDirection> directions;
  for (int k = 0; k < 6; ++k)
  {
    const Vector6d direction = solver.eigenvectors ().col (k);
    const DirectionSupport support = directionSupport (samples, chart, direction);
    directions.push_back ({direction, solver.eigenvalues ()[k], support.all,
                           support.all >= least_share * total || support.settled >= least_settled_share * total});
  }
  return directions;
}

ObservedMotion
observedMotion (const std::vector<SurfaceSample>& samples, const Eigen::Isometry3d& guess,
                const Eigen::Isometry3d& found, const MotionPrior& prior)
{
  ObservedMotion result;
  result.T_model_camera = guess;
  if (samples.empty ())
    return result;
  const MotionChart chart (samples);
  const double sigma = spread (samples);
  Vector6d moved = chart.coordinates (found * guess.inverse ());
  Matrix6d held_directions = Matrix6d::Zero ();
  int held_count = 0;
  for (const auto& [direction, curvature, support, observed] : principalDirections (samples, chart))
  {
    const double along = direction.dot (moved);
    const double variance = sigma * sigma * prior.correlated / curvature;
    const bool significant = along * along >= significance * significance * variance;
    result.directions += observed;
    if (observed)
      result.precision += curvature / std::max (sigma * sigma, least_sigma * least_sigma) * direction *
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
