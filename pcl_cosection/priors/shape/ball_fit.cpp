// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ball_fit.h"

#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int rounds = 12;             // of reweighting
constexpr double outlier_scale = 0.04; // of NormalLines::size: a distance from the surface with half weight
constexpr double facing_sine = 0.2;    // largest sine between a normal and the radial direction ...
constexpr double facing_reach = 0.02;  // ... plus this distance of the normal from the centre, of the size
constexpr double facing_share = 0.8;   // of the points
constexpr double inward_share = 0.05;  // of the points: with more facing inward, it is the inside of a bowl
constexpr double max_deviation = 0.05; // of the radius, root mean square, without noise
constexpr double max_noise = 0.15;     // of the radius, root mean square, of all points
constexpr double max_radius = 1.0;     // of the size: too small a part of a larger ball was seen
// Cells along the edge of a cube around the ball. Noise averages out in the cells of its faces, shape does not.
constexpr int cells = 4;

/** \brief Distances of points from a ball's surface. */
class BallDeviation
{
public:
  void add (const Eigen::Vector3d& from_center, double deviation)
  {
    Cell& cell = cells_[cellOf (from_center)];
    cell.sum += deviation;
    cell.squares += deviation * deviation;
    ++cell.points;
  }

  /** \brief Root mean square over all points: noise and shape. */
  double ofPoints () const
  {
    double squares = 0.0, points = 0.0;
    for (const Cell& cell : cells_)
    {
      squares += cell.squares;
      points += cell.points;
    }
    return std::sqrt (squares / points);
  }

  /** \brief Root mean square of the means over small ranges of directions: the deviation of the shape without noise. */
  double ofShape () const
  {
    double squares = 0.0, points = 0.0;
    for (const Cell& cell : cells_)
      if (cell.points > 0)
      {
        squares += cell.sum * cell.sum / cell.points;
        points += cell.points;
      }
    return std::sqrt (squares / points);
  }

private:
  struct Cell
  {
    double sum = 0.0, squares = 0.0;
    int points = 0;
  };

  static std::size_t cellOf (const Eigen::Vector3d& direction)
  {
    Eigen::Index axis;
    const double largest = direction.cwiseAbs ().maxCoeff (&axis);
    const auto along = [&] (Eigen::Index a) {
      const double place = largest > 0.0 ? 0.5 * (direction[a % 3] / largest + 1.0) : 0.0;
      return std::min (static_cast<int> (place * cells), cells - 1);
    };
    const int face = 2 * static_cast<int> (axis) + (direction[axis] > 0.0);
    return static_cast<std::size_t> ((face * cells + along (axis + 1)) * cells + along (axis + 2));
  }

  std::array<Cell, 6 * cells * cells> cells_;
};

/** \brief Fit a ball to positions, as noisy normals alone make it too small. */
Ball
fittedBall (Ball ball, const std::vector<NormalLine>& lines)
{
  for (int r = 0; r < rounds; ++r)
  {
    Eigen::Matrix4d left = Eigen::Matrix4d::Zero ();
    Eigen::Vector4d right = Eigen::Vector4d::Zero ();
    for (const NormalLine& line : lines)
    {
      const Eigen::Vector3d from_center = line.position - ball.center;
      const double residual = from_center.norm () - ball.radius;
      const Eigen::Vector4d slope = from_center.normalized ().homogeneous ();
      const double weight = cauchyWeight (residual / outlier_scale);
      left += weight * slope * slope.transpose ();
      right += weight * residual * slope;
    }
    const Eigen::Vector4d step = left.ldlt ().solve (right);
    ball.center += step.head<3> ();
    ball.radius += step[3];
  }
  return ball;
}

} // namespace

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
  ball = fittedBall (ball, lines);
  if (!(ball.radius < max_radius))
    return std::nullopt;
  std::size_t good = 0, inward = 0;
  BallDeviation deviation;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3d from_center = line.position - ball.center;
    const bool outward = from_center.dot (line.normal) > 0.0;
    inward += !outward;
    good += outward && from_center.cross (line.normal).norm () < facing_sine * ball.radius + facing_reach;
    deviation.add (from_center, from_center.norm () - ball.radius);
  }
  if (static_cast<double> (good) < facing_share * static_cast<double> (lines.size ()) ||
      static_cast<double> (inward) > inward_share * static_cast<double> (lines.size ()) ||
      deviation.ofShape () > max_deviation * ball.radius || deviation.ofPoints () > max_noise * ball.radius)
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

} // namespace pcl::cosection
