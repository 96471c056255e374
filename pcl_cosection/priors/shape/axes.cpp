// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "axes.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int rounds = 12;             // of reweighting
constexpr double outlier_scale = 0.04; // of the size: distance between normal and axis with half weight
constexpr double ridge = 1e-3;         // of the weights: keeps the axis where normals do not determine it
constexpr double meeting_sine = 0.2;   // largest sine between a normal and the direction to the axis ...
constexpr double meeting_reach = 0.02; // ... plus this distance from the axis, of the size
constexpr double sideways = 0.4;       // least sine between the axis and a normal that faces sideways
constexpr double least_sideways = 0.2; // share of all normals
constexpr double meeting_share = 0.75; // of those that face sideways
constexpr double vertical_share = 0.1; // a vertical axis is preferred if its share is less than this much lower

// Refinement of an axis. "Of the size" is relative to NormalLines::size.
constexpr int refining_steps = 8;
constexpr double band = 0.05;            // height of a band, of the size
constexpr double wall = 0.4;             // least radial component of a wall's normal, outward or inward
constexpr double least_radius = 0.02;    // of the size: nearer to the axis, radial directions are noise
constexpr std::size_t least_points = 10; // of a side in a band
constexpr double residual_scale = 2.0;   // of the median residual
constexpr double refining_ridge = 1e-6;  // keeps directions that the points do not determine
constexpr double farthest = 0.1;         // of the size: largest move of the axis

/** \brief Distance between axis and line, times the sine of the angle between them. */
double
distanceFrom (const Axis& axis, const NormalLine& line)
{
  return axis.direction.dot ((line.position - axis.point).cross (line.normal));
}

/** \brief The share of sideways normals that meet the axis; 0 if few normals face sideways. */
double
meetingShare (const Axis& axis, const std::vector<NormalLine>& lines)
{
  std::size_t all = 0, good = 0;
  for (const NormalLine& line : lines)
    if (facesSideways (axis.direction, line.normal))
    {
      ++all;
      good += meets (axis, line);
    }
  const bool enough = static_cast<double> (all) > least_sideways * static_cast<double> (lines.size ());
  return enough ? static_cast<double> (good) / static_cast<double> (all) : 0.0;
}

/** \brief Least squares of d.(p x n) + m.n over weighted lines. */
class AxisEquations
{
public:
  void add (const NormalLine& line, double weight)
  {
    moments_ += weight * line.moment * line.moment.transpose ();
    mixed_ += weight * line.normal * line.moment.transpose ();
    normals_ += weight * line.normal * line.normal.transpose ();
  }

  /** \brief The best axis of a given direction. */
  Axis along (const Eigen::Vector3d& direction) const
  {
    return {direction, direction.cross (momentsOfDirections () * direction)};
  }

  /** \brief The best axis, and the two best orthogonal to it. */
  std::array<Axis, 3> best () const
  {
    const Eigen::Matrix3d left = moments_ + mixed_.transpose () * momentsOfDirections ();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (0.5 * (left + left.transpose ()));
    return {along (solver.eigenvectors ().col (0)), along (solver.eigenvectors ().col (1)),
            along (solver.eigenvectors ().col (2))};
  }

private:
  Eigen::Matrix3d momentsOfDirections () const
  {
    return -(normals_ + ridge * normals_.trace () * Eigen::Matrix3d::Identity ()).inverse () * mixed_;
  }

  Eigen::Matrix3d moments_ = Eigen::Matrix3d::Zero ();
  Eigen::Matrix3d mixed_ = Eigen::Matrix3d::Zero ();
  Eigen::Matrix3d normals_ = Eigen::Matrix3d::Zero ();
};

AxisEquations
weighted (const std::vector<NormalLine>& lines, const Axis& axis)
{
  AxisEquations equations;
  for (const NormalLine& line : lines)
    equations.add (line, cauchyWeight (distanceFrom (axis, line) / outlier_scale));
  return equations;
}

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
  double squares = refining_ridge, slope = 0.0;
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

Scatter
scatterOf (const std::vector<OrientedPoint>& points)
{
  // One pass, relative to a point near the mean, so that no digits are lost.
  const Eigen::Vector3d about = points.empty () ? Eigen::Vector3d::Zero ()
                                                : points.front ().position.cast<double> ().eval ();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero ();
  Eigen::Vector3d mixed = Eigen::Vector3d::Zero (); // yz, xz, xy
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d d = p.position.cast<double> () - about;
    sum += d;
    squares += d.cwiseProduct (d);
    mixed += Eigen::Vector3d (d.y () * d.z (), d.x () * d.z (), d.x () * d.y ());
  }
  Scatter scatter;
  scatter.products << squares.x (), mixed.z (), mixed.y (), mixed.z (), squares.y (), mixed.x (), mixed.y (),
      mixed.x (), squares.z ();
  const Eigen::Vector3d offset = sum / static_cast<double> (points.size ());
  scatter.products -= offset * sum.transpose ();
  scatter.mean = about + offset;
  return scatter;
}

Eigen::Matrix3d
principalAxes (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector3d>& up)
{
  Eigen::Matrix3d covariance = scatterOf (points).products;
  if (up)
  {
    const Eigen::Matrix3d flatten = Eigen::Matrix3d::Identity () - *up * up->transpose ();
    covariance = flatten * covariance * flatten;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (covariance);
  Eigen::Vector3d longest = solver.eigenvectors ().col (2);
  const Eigen::Vector3d vertical = up ? *up : Eigen::Vector3d (solver.eigenvectors ().col (0));
  longest = (longest - vertical.dot (longest) * vertical).normalized ();
  if (!(longest.norm () > 0.5)) // all points lie on one line along up
    longest = vertical.unitOrthogonal ();
  Eigen::Matrix3d axes;
  axes << longest, vertical.cross (longest), vertical;
  return axes;
}

Eigen::Matrix3d
orientedAxes (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& up)
{
  Eigen::Matrix3d axes = principalAxes (points, up);
  const Eigen::Vector3d mean = scatterOf (points).mean;
  for (int a = 0; a < 2; ++a)
  {
    double skewness = 0.0;
    for (const OrientedPoint& point : points)
      skewness += std::pow (axes.col (a).dot (point.position.cast<double> () - mean), 3);
    if (skewness < 0.0)
      axes.col (a) = -axes.col (a);
  }
  return axes;
}

NormalLines
normalLinesOf (const std::vector<OrientedPoint>& points)
{
  const Scatter scatter = scatterOf (points);
  NormalLines all{{}, scatter.mean, 2.0 * std::sqrt (scatter.products.trace () / static_cast<double> (points.size ()))};
  if (!(all.size > 0.0))
    return {{}, scatter.mean, 0.0};
  all.lines.reserve (points.size ());
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d position = (p.position.cast<double> () - scatter.mean) / all.size;
    const Eigen::Vector3d normal = p.normal.cast<double> ();
    all.lines.push_back ({position, normal, position.cross (normal)});
  }
  return all;
}

bool
meets (const Axis& axis, const NormalLine& line)
{
  const double radius = (line.position - axis.point).cross (axis.direction).norm ();
  return std::abs (distanceFrom (axis, line)) < meeting_sine * radius + meeting_reach;
}

bool
facesSideways (const Eigen::Vector3d& direction, const Eigen::Vector3d& normal)
{
  return direction.cross (normal).norm () > sideways;
}

std::optional<Axis>
findAxis (const std::vector<NormalLine>& lines, const std::optional<Eigen::Vector3d>& up)
{
  AxisEquations all;
  for (const NormalLine& line : lines)
    all.add (line, 1.0);
  double best_share = 0.0;
  Axis best;
  const auto take = [&] (const Axis& axis, double least_share) {
    if (const double share = meetingShare (axis, lines); share > least_share)
    {
      best_share = share;
      best = axis;
    }
  };
  for (Axis axis : all.best ())
  {
    for (int r = 0; r < rounds; ++r)
    {
      const std::array<Axis, 3> axes = weighted (lines, axis).best ();
      axis = *std::max_element (axes.begin (), axes.end (), [&] (const Axis& a, const Axis& b) {
        return std::abs (a.direction.dot (axis.direction)) < std::abs (b.direction.dot (axis.direction));
      });
    }
    take (axis, best_share);
  }
  if (up)
  {
    Axis axis = all.along (*up);
    for (int r = 0; r < rounds; ++r)
      axis = weighted (lines, axis).along (*up);
    take (axis, best_share - vertical_share);
  }
  return best_share > meeting_share ? std::optional<Axis> (best) : std::nullopt;
}

Axis
refineAxis (const Axis& first, const std::vector<NormalLine>& lines)
{
  Axis axis = first;
  const Eigen::Vector3d x = axis.direction.unitOrthogonal ();
  const Eigen::Vector3d y = axis.direction.cross (x);
  double scale = 0.0; // residual with half weight
  for (int step = 0; step < refining_steps; ++step)
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
    scale = residual_scale * upperMedian (residuals);
    left.diagonal ().array () += refining_ridge * left.trace ();
    const Eigen::Vector2d change = left.ldlt ().solve (right);
    axis.point += change[0] * x + change[1] * y;
    if (!((axis.point - first.point).norm () < farthest)) // also for NaN
      return first;
  }
  return axis;
}

} // namespace pcl::cosection
