// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hidden_walls.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double steep = 0.3;          // largest component of a wall's normal upwards
constexpr double cell_steps = 1.5;     // width of a column
constexpr double end_steps = 3.0;      // height of the lowest part of a column, which shows how the wall ends
constexpr double least_walls = 0.7;    // share of wall points in that part
constexpr double least_aligned = 0.8;  // length of their mean normal
constexpr double contact_steps = 2.0;  // height over the plane below which a wall stands on it
constexpr int first_steps = 6;         // below the wall: occlusion must begin within these, as silhouettes are coarse
constexpr double least_hidden = 0.5;   // share of those places that something else hides
constexpr std::size_t sectors = 24;    // of directions, each with one inclination
constexpr double vertical_lean = 0.05; // a smaller inclination counts as vertical

/** \brief A point in axes of the plane. */
struct Raised
{
  Eigen::Vector2d place;
  double height;
  Eigen::Vector3d normal; // along the same axes
};

using Cell = std::pair<int, int>;

class Walls
{
public:
  Walls (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane, double step_m)
      : plane_ (plane)
      , step_m_ (step_m)
  {
    const Eigen::Vector3d up = plane.head<3> ();
    axes_.col (0) = up.unitOrthogonal ();
    axes_.col (1) = up.cross (axes_.col (0));
    axes_.col (2) = up;
    std::array<std::vector<double>, sectors> leans;
    for (const OrientedPoint& point : points)
    {
      if (!point.position.allFinite () || !point.normal.allFinite ())
        continue;
      const Eigen::Vector3d p = axes_.transpose () * point.position.cast<double> ();
      if (columns_.empty ())
        first_ = p.head<2> ();
      const Raised raised{p.head<2> (), p.z () + plane[3], axes_.transpose () * point.normal.cast<double> ()};
      columns_[cellOf (raised.place)].push_back (raised);
      if (isWall (raised))
        leans[sectorOf (raised.normal.x (), raised.normal.y (), sectors)].push_back (raised.normal.z ());
    }
    for (std::size_t s = 0; s < sectors; ++s)
      if (!leans[s].empty ())
        leans_[s] = quantile (leans[s], 0.5);
  }

  std::vector<OrientedPoint> continued (const UnseenPlaces& places) const
  {
    std::vector<OrientedPoint> all;
    for (const auto& [cell, column] : columns_)
    {
      const std::optional<Raised> end = endOf (cell, column);
      if (!end)
        continue;
      const std::vector<OrientedPoint> more = below (*end, places);
      all.insert (all.end (), more.begin (), more.end ());
    }
    return all;
  }

private:
  static bool isWall (const Raised& p) { return std::abs (p.normal.z ()) < steep; }

  Cell cellOf (const Eigen::Vector2d& place) const
  {
    const Eigen::Array2d cell = ((place - first_).array () / (cell_steps * step_m_)).floor ();
    return {static_cast<int> (cell.x ()), static_cast<int> (cell.y ())};
  }

  /** \brief The mean of the lowest part of a column, if the neighbourhood belongs to a wall too. */
  std::optional<Raised> endOf (const Cell& cell, const std::vector<Raised>& column) const
  {
    double lowest = std::numeric_limits<double>::infinity ();
    for (const Raised& p : column)
      lowest = std::min (lowest, p.height);
    if (lowest < contact_steps * step_m_)
      return std::nullopt;
    Raised end{Eigen::Vector2d::Zero (), lowest, Eigen::Vector3d::Zero ()};
    std::size_t near = 0, walls = 0, own = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
      {
        const auto neighbour = columns_.find ({cell.first + i, cell.second + j});
        if (neighbour == columns_.end ())
          continue;
        for (const Raised& p : neighbour->second)
        {
          if (p.height > lowest + end_steps * step_m_)
            continue;
          ++near;
          if (!isWall (p))
            continue;
          ++walls;
          end.normal += p.normal;
          if (i != 0 || j != 0)
            continue;
          end.place += p.place;
          ++own;
        }
      }
    if (own == 0 || static_cast<double> (walls) < least_walls * static_cast<double> (near) ||
        end.normal.norm () < least_aligned * static_cast<double> (walls))
      return std::nullopt;
    end.place /= static_cast<double> (own);
    const double lean = leans_[sectorOf (end.normal.x (), end.normal.y (), sectors)];
    end.normal.z () = std::abs (lean) < vertical_lean ? 0.0 : lean;
    end.normal.head<2> () *= std::sqrt (1.0 - end.normal.z () * end.normal.z ()) / end.normal.head<2> ().norm ();
    return end;
  }

  std::vector<OrientedPoint> below (const Raised& end, const UnseenPlaces& places) const
  {
    std::vector<OrientedPoint> points;
    std::size_t hidden = 0;
    const Eigen::Vector3d normal = axes_ * end.normal;
    const Eigen::Vector2d per_height = end.normal.head<2> () * end.normal.z () / end.normal.head<2> ().squaredNorm ();
    for (double depth = step_m_; depth < end.height; depth += step_m_)
    {
      const Eigen::Vector2d place = end.place + depth * per_height;
      const Eigen::Vector3d p = axes_ * Eigen::Vector3d (place.x (), place.y (), end.height - depth - plane_[3]);
      if (places.isTaken (p - step_m_ * normal))
        return {};
      hidden += places.is_behind_other (p);
      points.push_back ({p.cast<float> (), normal.cast<float> ()});
      if (points.size () == first_steps && hidden == 0)
        return {};
    }
    return static_cast<double> (hidden) < least_hidden * static_cast<double> (points.size ())
               ? std::vector<OrientedPoint> ()
               : points;
  }

  Eigen::Vector4d plane_;
  double step_m_;
  Eigen::Matrix3d axes_;                             // columns; the last one points upwards
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero (); // where cells begin
  std::map<Cell, std::vector<Raised>> columns_;
  std::array<double, sectors> leans_{};
};

} // namespace

std::vector<OrientedPoint>
wallsBehindOthers (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane, double step_m,
                   const UnseenPlaces& places)
{
  return Walls (points, plane, step_m).continued (places);
}

} // namespace pcl::cosection
