// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "inferred_support_plane.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/sectors.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/priors/shape/normal_axis.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 50;
constexpr double usual_wall = 0.04;  // of the radius
constexpr double lid_rise = 0.12;    // of the radius: a thing with a lower border may be a lid
constexpr double facing_down = -0.3; // component of a normal upwards
constexpr double down_share = 0.05;  // of all points: an open thing shows no more that face down
constexpr double level = 0.9;        // component of a floor's normal upwards
constexpr double floor_radius = 0.5; // of the radius: points of the floor are nearer to the middle
constexpr std::size_t least_floor = 10;
constexpr double outlier_share = 0.01; // of all points: those that may lie below the plane
constexpr int sectors = 36;            // around the middle
constexpr double rim_radius = 0.8;     // of the farthest point in a sector: points farther out are near the rim
constexpr double rim_outliers = 0.1;   // of those: points that may be higher than the rim
constexpr int higher_sectors = 27;     // least number with a rim higher than the floor

/** \brief The points around a vertical axis, by sector. */
class Surroundings
{
public:
  Surroundings (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up) : lines_ (lines), up_ (up)
  {
    const std::vector<std::size_t> rim = outermost (lines, up);
    for (const std::size_t n : rim)
      center_ += lines[n].position / static_cast<double> (rim.size ());
    for (const std::size_t n : rim)
      radius_ += radiusOf (lines[n].position) / static_cast<double> (rim.size ());
  }

  /** \brief Mean over sectors of the largest distance from the axis. */
  double radius () const { return radius_; }

  /** \brief Points with vertical normals in the middle. */
  std::vector<Eigen::Vector3d> floor () const
  {
    std::vector<Eigen::Vector3d> floor;
    for (const NormalLine& line : lines_)
      if (up_.dot (line.normal) > level && radiusOf (line.position) < floor_radius * radius_)
        floor.push_back (line.position);
    return floor;
  }

  /** \brief Number of sectors whose rim is higher than \a height. */
  std::ptrdiff_t sectorsHigherThan (double height) const
  {
    const Sectors numbers (up_, sectors);
    std::array<std::vector<Eigen::Vector3d>, sectors> around;
    std::array<double, sectors> reach{};
    for (const NormalLine& line : lines_)
    {
      const std::size_t s = numbers.of (line.position - center_);
      around[s].push_back (line.position);
      reach[s] = std::max (reach[s], radiusOf (line.position));
    }
    std::ptrdiff_t count = 0;
    for (std::size_t s = 0; s < sectors; ++s)
    {
      std::size_t near = 0, higher = 0;
      for (const Eigen::Vector3d& p : around[s])
        if (radiusOf (p) > rim_radius * reach[s])
        {
          ++near;
          higher += up_.dot (p) > height;
        }
      count += near > 0 && static_cast<double> (higher) > rim_outliers * static_cast<double> (near);
    }
    return count;
  }

private:
  double radiusOf (const Eigen::Vector3d& p) const { return up_.cross (p - center_).norm (); }

  const std::vector<NormalLine>& lines_;
  Eigen::Vector3d up_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double radius_ = 0.0;
};

} // namespace

std::optional<Eigen::Vector4d>
inferredSupportPlane (const std::vector<OrientedPoint>& points)
{
  if (points.size () < least_points)
    return std::nullopt;
  const NormalLines normals = normalLinesOf (points);
  std::optional<Eigen::Vector3d> up = normals.lines.empty () ? std::nullopt : rimNormal (normals.lines);
  if (!up)
    return std::nullopt;
  if (const std::vector<Eigen::Vector3d> floor = Surroundings (normals.lines, *up).floor ();
      floor.size () >= least_floor)
    up = planeNormal (floor, *up);
  const Surroundings around (normals.lines, *up);
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : around.floor ())
    heights.push_back (up->dot (p));
  const auto down = std::count_if (normals.lines.begin (), normals.lines.end (),
                                   [&] (const NormalLine& line) { return up->dot (line.normal) < facing_down; });
  if (heights.size () < least_floor || static_cast<double> (down) > down_share * static_cast<double> (points.size ()))
    return std::nullopt;
  const double floor = quantile (heights, 0.5);
  const double wall = usual_wall * around.radius ();
  if (around.sectorsHigherThan (floor + std::max (wall, lid_rise * around.radius ())) < higher_sectors)
    return std::nullopt;
  std::vector<double> all;
  for (const NormalLine& line : normals.lines)
    all.push_back (up->dot (line.position));
  const double height = std::min (floor - wall, quantile (all, outlier_share));
  Eigen::Vector4d plane;
  plane << *up, -(normals.size * height + up->dot (normals.origin));
  return plane;
}

} // namespace pcl::cosection
