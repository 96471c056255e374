// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "box_outline.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double facing = 0.8;            // least component of a wall's normal along its outward direction
constexpr double wall_reach = 0.5;        // of the half sizes: walls are farther out
constexpr double side_reach = 0.9;        // of the half sizes: corners are farther along a wall
constexpr double floor_reach = 0.7;       // of the half sizes: points of the floor are nearer
constexpr double border_reach = 0.8;      // of the half sizes: floor points farther out show that a wall is missing
constexpr double level = 0.9;             // component of a floor's normal upwards
constexpr std::size_t least_points = 10;  // of a side or of the floor
constexpr std::size_t parts = 8;          // of the length of a side
constexpr std::ptrdiff_t least_parts = 3; // in which it must be seen
constexpr double least_rise = 0.2;        // least observed height of a side, relative to the walls' height or the width
constexpr double outlier_share = 0.01;
constexpr std::size_t least_walls = 3;
constexpr std::size_t least_inner = 2; // walls seen from inside
constexpr double thinnest = 0.01;      // least wall thickness, of the smaller half size
constexpr double near_spreads = 1.5;   // in median distances from a side: nearer points are on it
constexpr double lowest_share = 0.02;  // of the points of outer sides: outliers below the bottom

struct Range
{
  double low = std::numeric_limits<double>::infinity ();
  double high = -std::numeric_limits<double>::infinity ();
};

/** \brief The inner or the outer side of a wall. */
struct Side
{
  std::vector<double> places;    // outward positions of its points, moved along the wall to height 0
  std::vector<double> heights;   // of its points
  std::array<Range, parts> seen; // range of heights, by part of the length

  double place () const
  {
    std::vector<double> values = places;
    return quantile (values, 0.5);
  }

  /** \brief Whether enough of the side was seen; otherwise it may be the edge of something else. */
  bool isSeen (double least_rise_m) const
  {
    return places.size () >= least_points && std::count_if (seen.begin (), seen.end (), [&] (const Range& part) {
                                               return part.high - part.low > least_rise_m;
                                             }) >= least_parts;
  }
};

struct Wall
{
  Side outer, inner;
  std::size_t border = 0; // number of floor points at the place of the wall
  std::size_t rim = 0;    // number of points of its rim
};

class BoxWalls
{
public:
  BoxWalls (const std::vector<BoxPoint>& points, const Eigen::Array2d& half_sizes) : half_sizes_ (half_sizes)
  {
    for (const BoxPoint& p : points)
      if (p.normal.z () > level && (p.position.head<2> ().array ().abs () < floor_reach * half_sizes).all ())
        floor_.push_back (p.position.z ());
    const bool has_floor = floor_.size () >= least_points;
    std::vector<double> heights;
    for (const BoxPoint& p : points)
      heights.push_back (p.position.z ());
    const double floor = has_floor ? quantile (floor_, 0.5) : quantile (heights, outlier_share);
    height_ = quantile (heights, 1.0 - outlier_share) - floor;
    least_rise_m_ = least_rise * std::min (height_, 2.0 * half_sizes.minCoeff ());
    for (const BoxPoint& p : points)
      for (int axis = 0; axis < 2; ++axis)
        add (p, axis, floor);
  }

  /** \param[in] bottom height, if known */
  std::optional<BoxOutline> outline (const std::optional<double>& bottom)
  {
    const double thickness = wallThickness (bottom);
    if (!(thickness > thinnest * half_sizes_.minCoeff ()))
      return std::nullopt;
    std::array<double, 4> ends{};
    std::size_t known = 0, inner = 0;
    double excess = 0.0; // of the half sizes over the positions of seen walls
    for (std::size_t w = 0; w < walls_.size (); ++w)
    {
      const Wall& wall = walls_[w];
      const double o = wall.outer.isSeen (least_rise_m_) ? static_cast<double> (wall.outer.places.size ()) : 0.0;
      const double i = wall.inner.isSeen (least_rise_m_) ? static_cast<double> (wall.inner.places.size ()) : 0.0;
      inner += i > 0.0;
      if (!(o + i > 0.0))
      {
        if (wall.border >= least_points && wall.rim < least_points)
          return std::nullopt;
        continue;
      }
      ends[w] = ((o > 0.0 ? o * wall.outer.place () : 0.0) + (i > 0.0 ? i * (wall.inner.place () + thickness) : 0.0)) /
                (o + i);
      excess += half_sizes_[w % 2] - ends[w];
      ++known;
    }
    const bool may_lack_one = bottom || floor_.size () >= least_points; // otherwise that side may be open
    if (known < (may_lack_one ? least_walls : walls_.size ()) || inner < least_inner)
      return std::nullopt;
    for (std::size_t w = 0; w < walls_.size (); ++w)
      if (!(ends[w] > 0.0))
        ends[w] = half_sizes_[w % 2] - excess / static_cast<double> (known);
    if (!(*std::min_element (ends.begin (), ends.end ()) > 0.0))
      return std::nullopt;
    return BoxOutline{{0.5 * (ends[0] - ends[2]), 0.5 * (ends[1] - ends[3])},
                      {0.5 * (ends[0] + ends[2]), 0.5 * (ends[1] + ends[3])},
                      known};
  }

private:
  void add (const BoxPoint& p, int axis, double floor)
  {
    const bool is_level = p.normal.z () > level;
    const bool is_low = p.position.z () - floor < 0.5 * height_;
    const double sense = p.position[axis] < 0.0 ? -1.0 : 1.0;
    const double along = p.position[1 - axis] / (side_reach * half_sizes_[1 - axis]);
    const double distance = sense * p.position[axis] / half_sizes_[axis];
    if (!(std::abs (along) < 1.0))
      return;
    Wall& wall = walls_[static_cast<std::size_t> (axis) + (sense < 0.0 ? 2 : 0)];
    if (is_level && distance > border_reach)
      ++(is_low ? wall.border : wall.rim);
    const double out = sense * p.normal[axis];
    if (is_level || std::abs (out) < facing || distance < wall_reach)
      return;
    Side& side = out > 0.0 ? wall.outer : wall.inner;
    side.places.push_back (sense * p.position[axis] + p.normal.z () / out * p.position.z ());
    side.heights.push_back (p.position.z ());
    if (!(p.position.z () > floor)) // the edge of a floor is no wall
      return;
    Range& part = side.seen[std::min (parts - 1, static_cast<std::size_t> (0.5 * (along + 1.0) * parts))];
    part.low = std::min (part.low, p.position.z ());
    part.high = std::max (part.high, p.position.z ());
  }

  /** \brief Heights of points that lie on the outer sides, not beside them. */
  std::vector<double> outerHeights () const
  {
    std::vector<double> heights;
    for (const Wall& wall : walls_)
    {
      if (!wall.outer.isSeen (least_rise_m_))
        continue;
      const double place = wall.outer.place ();
      std::vector<double> off;
      for (const double other : wall.outer.places)
        off.push_back (std::abs (other - place));
      std::vector<double> sorted = off;
      const double near = near_spreads * quantile (sorted, 0.5);
      for (std::size_t n = 0; n < off.size (); ++n)
        if (off[n] <= near)
          heights.push_back (wall.outer.heights[n]);
    }
    return heights;
  }

  /** \brief The wall thickness that remains of the widths where walls were seen from one side only: the mean of both
   * widths, as outliers enlarge and coarse pixels shrink them. */
  double leftByWidths () const
  {
    double sum = 0.0, walls = 0.0;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      double left = 2.0 * half_sizes_[static_cast<Eigen::Index> (axis)];
      int inner = 0, seen = 0;
      for (const Wall* wall : {&walls_[axis], &walls_[axis + 2]})
        if (const bool is_outer = wall->outer.isSeen (least_rise_m_); is_outer || wall->inner.isSeen (least_rise_m_))
        {
          left -= (is_outer ? wall->outer : wall->inner).place ();
          inner += !is_outer;
          ++seen;
        }
      if (seen == 2 && inner > 0)
      {
        sum += left / inner;
        walls += 1.0;
      }
    }
    return walls > 0.0 ? std::max (0.0, sum / walls) : 0.0;
  }

  /** \brief The wall thickness where both sides were seen; otherwise that of the floor, limited by leftByWidths (). */
  double wallThickness (const std::optional<double>& bottom)
  {
    double sum = 0.0, weights = 0.0;
    for (const Wall& wall : walls_)
      if (wall.outer.isSeen (least_rise_m_) && wall.inner.isSeen (least_rise_m_))
      {
        const auto weight = static_cast<double> (std::min (wall.outer.places.size (), wall.inner.places.size ()));
        sum += weight * (wall.outer.place () - wall.inner.place ());
        weights += weight;
      }
    if (weights > 0.0)
      return std::max (0.0, sum / weights);
    std::vector<double> heights = outerHeights ();
    if (floor_.size () < least_points || (!bottom && heights.size () < least_points))
      return leftByWidths ();
    const double by_floor = std::max (0.0,
                                      quantile (floor_, 0.5) - (bottom ? *bottom : quantile (heights, lowest_share)));
    const double left = leftByWidths ();
    if (!bottom && by_floor < thinnest * half_sizes_.minCoeff ()) // from above, little of outer sides is visible
      return left;
    return left > 0.0 ? std::min (by_floor, left) : by_floor;
  }

  Eigen::Array2d half_sizes_;
  std::array<Wall, 4> walls_; // along x, y, -x and -y
  std::vector<double> floor_; // heights
  double height_ = 0.0;       // of the walls above the floor
  double least_rise_m_ = 0.0; // least observed height of a side
};

} // namespace

std::optional<BoxOutline>
outlineByWalls (const std::vector<BoxPoint>& points, const Eigen::Array2d& half_sizes,
                const std::optional<double>& bottom)
{
  return BoxWalls (points, half_sizes).outline (bottom);
}

double
RectangularOutline::distance (const Eigen::Vector2d& q) const
{
  return (q.array ().abs () - half_sizes_).maxCoeff () + half_sizes_.minCoeff ();
}

Eigen::Vector2d
RectangularOutline::away (const Eigen::Vector2d& q) const
{
  Eigen::Index axis;
  (q.array ().abs () - half_sizes_).maxCoeff (&axis);
  return (q[axis] < 0.0 ? -1.0 : 1.0) * Eigen::Vector2d::Unit (axis);
}

std::vector<Eigen::Vector2d>
RectangularOutline::outline (double distance, double step) const
{
  const Eigen::Array2d half = halfSizesAt (distance);
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Index axis : {0, 1})
  {
    const double length = half[1 - axis];
    const int steps = std::max (1, static_cast<int> (std::ceil (2.0 * length / step)));
    for (const double sense : {1.0, -1.0})
      for (int i = 0; i < steps; ++i)
        points.push_back (sense * (half[axis] * Eigen::Vector2d::Unit (axis) +
                                   (2.0 * i / steps - 1.0) * length * Eigen::Vector2d::Unit (1 - axis)));
  }
  return points;
}

} // namespace pcl::cosection
