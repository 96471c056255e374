// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "observed_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl
{
namespace cosection
{

namespace
{

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double least_slope = 0.3;  // of the distance: smaller ones are where it is truncated
constexpr double facing = 0.5;       // of the slope along a direction, from which on a point tells of it
constexpr double significance = 3.0; // standard deviations
constexpr double least_share = 0.005; // of all points' weight, times the square of that
constexpr double least_settled_share = 0.001; // the same of points at voxels ...
constexpr float settled_weight = 4.0f;        // ... that were seen as often: less noise, which bends distances

struct Sample
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
  double weight;
  double distance;
  bool settled;
};

/** \brief Differences of the distance along the axes; nothing where one of them is not known. */
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

/** \brief Standard deviation of the distance of a point of weight 1, from the median. */
double
spread (const std::vector<Sample>& samples)
{
  std::vector<double> sizes (samples.size ());
  std::transform (samples.begin (), samples.end (), sizes.begin (),
                  [] (const Sample& sample) { return std::abs (sample.distance) * std::sqrt (sample.weight); });
  const auto middle = sizes.begin () + static_cast<std::ptrdiff_t> (sizes.size () / 2);
  std::nth_element (sizes.begin (), middle, sizes.end ());
  return 1.4826 * *middle;
}

} // namespace

ObservedMotion
observedMotion (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights, const TsdfVolume& volume,
                const Eigen::Isometry3d& guess, const Eigen::Isometry3d& found, const MotionPrior& prior)
{
  std::vector<Sample> samples;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero ();
  double total = 0.0;
  const std::size_t step = std::max<std::size_t> (1, points.size () / prior.most_points);
  for (std::size_t n = 0; n < points.size (); n += step)
  {
    const Eigen::Vector3d p = found * points[n].cast<double> ();
    const auto cell = weights[n] > 0.0f ? volume.sample<double> (p) : std::nullopt;
    const auto slope = cell && prior.reach_vox > 0.0 ? slopeAround (volume, p, prior.reach_vox)
                                                     : (cell ? std::optional<Eigen::Vector3d> (cell->gradient ()) : std::nullopt);
    if (!slope || slope->norm () < least_slope)
      continue;
    samples.push_back ({p, slope->normalized (), weights[n], cell->value (), volume.weight (p) >= settled_weight});
    centre += weights[n] * p;
    total += weights[n];
  }
  ObservedMotion result;
  result.T_model_camera = guess;
  if (!(total > 0.0))
    return result;
  centre /= total;
  double squares = 0.0;
  for (const Sample& sample : samples)
    squares += sample.weight * (sample.position - centre).squaredNorm ();
  const double radius = std::max (1e-6, std::sqrt (squares / total)); // rotations in its units

  const auto jacobian = [&] (const Sample& sample) {
    Vector6d row;
    row << sample.normal, (sample.position - centre).cross (sample.normal) / radius;
    return row;
  };
  Matrix6d curvature = Matrix6d::Zero ();
  for (const Sample& sample : samples)
  {
    const Vector6d row = jacobian (sample);
    curvature += sample.weight * row * row.transpose ();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (curvature);
  const Matrix6d directions = solver.eigenvectors ();
  const double sigma = spread (samples);

  const Eigen::Isometry3d motion = found * guess.inverse ();
  const Eigen::AngleAxisd turn (motion.linear ());
  Vector6d moved;
  moved << motion * centre - centre, radius * turn.angle () * turn.axis ();
  Matrix6d held_directions = Matrix6d::Zero ();
  int held_count = 0;
  for (int k = 0; k < 6; ++k)
  {
    const Vector6d direction = directions.col (k);
    double told = 0.0, told_settled = 0.0;
    for (const Sample& sample : samples)
    {
      const double along = jacobian (sample).dot (direction);
      if (std::abs (along) >= facing)
      {
        told += sample.weight * along * along;
        told_settled += sample.settled ? sample.weight * along * along : 0.0;
      }
    }
    const double along = direction.dot (moved);
    const bool observed = told >= least_share * total || told_settled >= least_settled_share * total;
    const double variance = sigma * sigma * prior.correlated / (solver.eigenvalues ()[k] * static_cast<double> (step));
    const bool significant = along * along >= significance * significance * variance;
    result.directions += observed;
    result.held += observed && !significant;
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
  const Eigen::Vector3d rotation = moved.tail<3> () / radius;
  Eigen::Isometry3d held = Eigen::Isometry3d::Identity ();
  if (rotation.norm () > 0.0)
    held.linear () = Eigen::AngleAxisd (rotation.norm (), rotation.normalized ()).toRotationMatrix ();
  held.translation () = centre + moved.head<3> () - held.linear () * centre;
  result.T_model_camera = held * guess;
  return result;
}

} // namespace cosection
} // namespace pcl
