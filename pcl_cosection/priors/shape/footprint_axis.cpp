// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "footprint_axis.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr int directions = 72; // in each of which the outermost point is found
constexpr int sectors = 36;
constexpr double outlier_share = 0.002;  // of all points: outliers that lie farther out
constexpr double sector_outliers = 0.05; // of the points of a sector
constexpr double round_reach = 0.065;    // of the radius: largest deviation in a sector of a round thing
constexpr int round_sectors = 22;        // least number of such sectors; noise spoils some
constexpr double least_facing = 0.2;     // least length of the mean normal, if points mostly face one way
constexpr int rim_rounds = 5;
constexpr int plane_rounds = 20;
constexpr double plane_reach = 0.02; // of NormalLines::size: distance from the plane with a low weight

using Points = std::vector<Eigen::Vector2d>;

/** \brief Points as seen from above. */
struct Footprint
{
  Footprint (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up)
      : x (up.unitOrthogonal ())
      , y (up.cross (x))
  {
    points.reserve (lines.size ());
    for (const NormalLine& line : lines)
      points.emplace_back (x.dot (line.position), y.dot (line.position));
  }

  Eigen::Vector3d x, y;
  Points points;
};

/** \brief Indices of the points that are farthest along each of some directions. */
std::vector<std::size_t>
farthestOf (const Points& points)
{
  std::vector<std::size_t> ends, order (points.size ());
  std::iota (order.begin (), order.end (), std::size_t (0));
  const auto rank = order.begin () + static_cast<std::ptrdiff_t> (outlier_share * static_cast<double> (points.size ()));
  for (int d = 0; d < directions; ++d)
  {
    const double angle = 2.0 * M_PI * d / directions;
    const Eigen::Vector2d direction (std::cos (angle), std::sin (angle));
    const auto farther = [&] (std::size_t a, std::size_t b) {
      const double along_a = direction.dot (points[a]), along_b = direction.dot (points[b]);
      return along_a > along_b || (along_a == along_b && a < b);
    };
    std::nth_element (order.begin (), rank, order.end (), farther);
    ends.push_back (*rank);
  }
  return ends;
}

/** \brief The centre of the algebraically fitted circle. */
Eigen::Vector2d
circleCenter (const Points& points)
{
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d right = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector2d& p : points)
  {
    const Eigen::Vector3d row (2.0 * p.x (), 2.0 * p.y (), 1.0);
    left += row * row.transpose ();
    right += p.squaredNorm () * row;
  }
  return left.ldlt ().solve (right).head<2> ();
}

/** \brief Whether the points extend equally far from a place in nearly all directions. */
bool
isRound (const Points& points, const Eigen::Vector2d& center)
{
  std::array<std::vector<double>, sectors> radii;
  for (const Eigen::Vector2d& p : points)
  {
    const Eigen::Vector2d q = p - center;
    radii[sectorOf (q.x (), q.y (), sectors)].push_back (q.norm ());
  }
  std::vector<double> reaches;
  for (std::vector<double>& sector : radii)
    if (!sector.empty ())
      reaches.push_back (trimmedMax (sector, sector_outliers));
  const double radius = quantile (reaches, 0.5);
  const auto alike = std::count_if (reaches.begin (), reaches.end (),
                                    [&] (double reach) { return std::abs (reach - radius) < round_reach * radius; });
  return alike >= round_sectors;
}

} // namespace

std::optional<Axis>
findFootprintAxis (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up)
{
  if (lines.empty ())
    return std::nullopt;
  const Footprint footprint (lines, up);
  Points ends;
  for (const std::size_t n : farthestOf (footprint.points))
    ends.push_back (footprint.points[n]);
  const Eigen::Vector2d center = circleCenter (ends);
  if (!center.allFinite () || !isRound (footprint.points, center))
    return std::nullopt;
  return Axis{up, center.x () * footprint.x + center.y () * footprint.y};
}

std::vector<std::size_t>
outermost (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up)
{
  return farthestOf (Footprint (lines, up).points);
}

Eigen::Vector3d
planeNormal (const std::vector<Eigen::Vector3d>& points, Eigen::Vector3d normal)
{
  Eigen::Vector3d center = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3d& p : points)
    center += p / static_cast<double> (points.size ());
  for (int round = 0; round < plane_rounds; ++round)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
    double weights = 0.0;
    for (const Eigen::Vector3d& p : points)
    {
      const double weight = cauchyWeight (normal.dot (p - center) / plane_reach);
      sum += weight * (p - center);
      products += weight * (p - center) * (p - center).transpose ();
      weights += weight;
    }
    const Eigen::Vector3d mean = sum / weights;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (products / weights - mean * mean.transpose ());
    const Eigen::Vector3d least = solver.eigenvectors ().col (0);
    normal = least.dot (normal) < 0.0 ? Eigen::Vector3d (-least) : least;
    center += mean;
  }
  return normal;
}

std::optional<Eigen::Vector3d>
rimNormal (const std::vector<NormalLine>& lines)
{
  Eigen::Vector3d up = Eigen::Vector3d::Zero ();
  for (const NormalLine& line : lines)
    up += line.normal;
  if (up.norm () < least_facing * static_cast<double> (lines.size ()))
    return std::nullopt;
  up.normalize ();
  for (int round = 0; round < rim_rounds; ++round)
  {
    std::vector<Eigen::Vector3d> rim;
    for (const std::size_t n : outermost (lines, up))
      rim.push_back (lines[n].position);
    up = planeNormal (rim, up);
  }
  return up;
}

} // namespace pcl::cosection
