// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "normal_axis.h"

#include "principal_axes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr int rounds = 12;                // of reweighting
constexpr double outlier_scale = 0.04;    // of the size: a normal's distance from the axis that counts half
constexpr double ridge = 1e-3;            // of the weights: where normals say nothing of the axis, it stays near
constexpr double meeting_sine = 0.2;      // between a normal and the way to the axis
constexpr double meeting_reach = 0.02;    // of the size, more than that
constexpr double sideways = 0.4;          // sine between the axis and a normal
constexpr double least_sideways = 0.2;    // of all normals
constexpr double meeting_share = 0.75;    // of those that face sideways
constexpr double upright_share = 0.1;     // less than that of the best axis: an upright one is as good
constexpr double ball_share = 0.9;        // of the points
constexpr double ball_deviation = 0.05;   // of the radius, root mean square
constexpr double max_ball_radius = 1.0;   // of the size: of a larger ball too little was seen

/** \brief Between axis and line, times the sine of the angle between them. */
double
distanceFrom (const Axis& axis, const NormalLine& line)
{
  return axis.direction.dot ((line.position - axis.point).cross (line.normal));
}

/** \brief Of those lines that tell, how many meet the axis? 0 if few tell. */
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
  void
  add (const NormalLine& line, double weight)
  {
    moments_ += weight * line.moment * line.moment.transpose ();
    mixed_ += weight * line.normal * line.moment.transpose ();
    normals_ += weight * line.normal * line.normal.transpose ();
  }

  /** \brief The best axis of a given direction. */
  Axis
  along (const Eigen::Vector3d& direction) const
  {
    return {direction, direction.cross (momentsOfDirections () * direction)};
  }

  /** \brief The best axis, and the best of those across it. */
  std::array<Axis, 3>
  best () const
  {
    const Eigen::Matrix3d left = moments_ + mixed_.transpose () * momentsOfDirections ();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (0.5 * (left + left.transpose ()));
    return {along (solver.eigenvectors ().col (0)), along (solver.eigenvectors ().col (1)), along (solver.eigenvectors ().col (2))};
  }

private:
  Eigen::Matrix3d
  momentsOfDirections () const
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
  {
    const double distance = distanceFrom (axis, line) / outlier_scale;
    equations.add (line, 1.0 / (1.0 + distance * distance));
  }
  return equations;
}

} // namespace

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
  for (Axis axis : all.best ())
  {
    for (int r = 0; r < rounds; ++r)
    {
      const std::array<Axis, 3> axes = weighted (lines, axis).best ();
      axis = *std::max_element (axes.begin (), axes.end (), [&] (const Axis& a, const Axis& b) {
        return std::abs (a.direction.dot (axis.direction)) < std::abs (b.direction.dot (axis.direction));
      });
    }
    if (const double share = meetingShare (axis, lines); share > best_share)
    {
      best_share = share;
      best = axis;
    }
  }
  if (up)
  {
    Axis axis = all.along (*up);
    for (int r = 0; r < rounds; ++r)
      axis = weighted (lines, axis).along (*up);
    if (const double share = meetingShare (axis, lines); share > best_share - upright_share)
    {
      best_share = share;
      best = axis;
    }
  }
  return best_share > meeting_share ? std::optional<Axis> (best) : std::nullopt;
}

std::optional<Ball>
findBall (const std::vector<NormalLine>& lines)
{
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d right = Eigen::Vector3d::Zero ();
  for (const NormalLine& line : lines)
  {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity () - line.normal * line.normal.transpose ();
    left += across;
    right += across * line.position;
  }
  Ball ball{left.ldlt ().solve (right), 0.0};
  for (const NormalLine& line : lines)
    ball.radius += (line.position - ball.center).norm () / static_cast<double> (lines.size ());
  if (!(ball.radius < max_ball_radius))
    return std::nullopt;
  std::size_t good = 0;
  double deviation = 0.0;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3d from_center = line.position - ball.center;
    good += from_center.dot (line.normal) > 0.0 &&
            from_center.cross (line.normal).norm () < meeting_sine * ball.radius + meeting_reach;
    deviation += std::pow (from_center.norm () - ball.radius, 2) / static_cast<double> (lines.size ());
  }
  if (static_cast<double> (good) < ball_share * static_cast<double> (lines.size ()) ||
      std::sqrt (deviation) > ball_deviation * ball.radius)
    return std::nullopt;
  return ball;
}

Axis
axisOf (const Ball& ball, const std::vector<NormalLine>& lines)
{
  Eigen::Vector3d seen = Eigen::Vector3d::Zero ();
  for (const NormalLine& line : lines)
    seen += line.normal;
  return {seen.norm () > 0.0 ? Eigen::Vector3d (seen.unitOrthogonal ()) : Eigen::Vector3d::UnitX (), ball.center};
}

} // namespace cosection
} // namespace pcl
