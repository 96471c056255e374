// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "normal_axis.h"

#include "principal_axes.h"

#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

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
  {
    const double distance = distanceFrom (axis, line) / outlier_scale;
    equations.add (line, cauchyWeight (distance));
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
    if (const double share = meetingShare (axis, lines); share > best_share - vertical_share)
    {
      best_share = share;
      best = axis;
    }
  }
  return best_share > meeting_share ? std::optional<Axis> (best) : std::nullopt;
}

} // namespace pcl::cosection
