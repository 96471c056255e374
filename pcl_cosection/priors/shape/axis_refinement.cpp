// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "axis_refinement.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int steps = 8;
// "Of the size" is relative to NormalLines::size.
constexpr double band = 0.05;            // height of a band, of the size
constexpr double wall = 0.4;             // least radial component of a wall's normal, outward or inward
constexpr double least_radius = 0.02;    // of the size: nearer to the axis, radial directions are noise
constexpr std::size_t least_points = 10; // of a side in a band
constexpr double outlier_scale = 2.0;    // of the median residual
constexpr double ridge = 1e-6;           // keeps directions that the points do not determine
constexpr double farthest = 0.1;         // of the size: largest move of the axis

struct Sample
{
  double height, radius;
  Eigen::Vector2d change; // derivative of the radius by the axis' position along x and y
};

/** \brief Replace the radii of one band by their residuals from a line fit over height, and their derivatives
 * accordingly. */
void
straighten (std::vector<Sample>& band)
{
  const auto count = static_cast<double> (band.size ());
  double height = 0.0, radius = 0.0;
  Eigen::Vector2d change = Eigen::Vector2d::Zero ();
  for (const Sample& s : band)
  {
    height += s.height / count;
    radius += s.radius / count;
    change += s.change / count;
  }
  double squares = ridge, slope = 0.0;
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero ();
  for (Sample& s : band)
  {
    s.height -= height;
    s.radius -= radius;
    s.change -= change;
    squares += s.height * s.height;
    slope += s.height * s.radius;
    slopes += s.height * s.change;
  }
  for (Sample& s : band)
  {
    s.radius -= slope / squares * s.height;
    s.change -= slopes / squares * s.height;
  }
}

} // namespace

Axis
refineAxis (const Axis& first, const std::vector<NormalLine>& lines)
{
  Axis axis = first;
  const Eigen::Vector3d x = axis.direction.unitOrthogonal ();
  const Eigen::Vector3d y = axis.direction.cross (x);
  double scale = 0.0; // residual with half weight
  for (int step = 0; step < steps; ++step)
  {
    std::map<std::pair<int, bool>, std::vector<Sample>> bands; // by height and side
    for (const NormalLine& line : lines)
    {
      const Eigen::Vector3d q = line.position - axis.point;
      const double height = axis.direction.dot (q);
      const Eigen::Vector3d away = q - height * axis.direction;
      const double radius = away.norm ();
      if (radius < least_radius || std::abs (line.normal.dot (away)) < wall * radius)
        continue;
      bands[{static_cast<int> (std::floor (height / band)), line.normal.dot (away) < 0.0}].push_back (
          {height, radius, Eigen::Vector2d (-x.dot (away) / radius, -y.dot (away) / radius)});
    }
    Eigen::Matrix2d left = Eigen::Matrix2d::Zero ();
    Eigen::Vector2d right = Eigen::Vector2d::Zero ();
    std::vector<double> residuals;
    for (auto& [key, samples] : bands)
    {
      if (samples.size () < least_points)
        continue;
      straighten (samples);
      for (const Sample& s : samples)
      {
        residuals.push_back (std::abs (s.radius));
        const double weight = cauchyWeight (scale > 0.0 ? s.radius / scale : 0.0);
        left += weight * s.change * s.change.transpose ();
        right -= weight * s.change * s.radius;
      }
    }
    if (residuals.empty ())
      return first;
    scale = outlier_scale * upperMedian (residuals);
    left.diagonal ().array () += ridge * left.trace ();
    const Eigen::Vector2d change = left.ldlt ().solve (right);
    axis.point += change[0] * x + change[1] * y;
    if (!((axis.point - first.point).norm () < farthest)) // also for NaN
      return first;
  }
  return axis;
}

} // namespace pcl::cosection
