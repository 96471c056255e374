// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ear_clipping.h"

#include "convex_hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>

namespace pcl::cosection {
namespace {

using Point = Eigen::Vector2d;

/** \brief Points in the cells of a grid that has about as many cells as points. */
class PointGrid
{
public:
  PointGrid (const std::vector<Point>& points, const std::vector<std::uint32_t>& chosen)
  {
    Eigen::AlignedBox2d box;
    for (const std::uint32_t n : chosen)
      box.extend (points[n]);
    side_ = std::max (1, static_cast<int> (std::sqrt (static_cast<double> (chosen.size ()))));
    if (!chosen.empty ())
      origin_ = box.min ();
    // Points on a line across an axis are in one cell along it: what rounding makes of their distances is no length.
    constexpr double rounding = 1e-12;
    for (int axis = 0; axis < 2; ++axis)
      if (!chosen.empty () && box.sizes ()[axis] > rounding * (box.min ().norm () + box.max ().norm ()))
        if (const double cells = side_ / box.sizes ()[axis]; std::isfinite (cells)) // else lengths are denormal
          cells_per_length_[axis] = cells;
    begin_.assign (static_cast<std::size_t> (side_) * side_ + 1, 0);
    for (const std::uint32_t n : chosen)
      ++begin_[cellOf (points[n]) + 1];
    std::partial_sum (begin_.begin (), begin_.end (), begin_.begin ());
    std::vector<std::uint32_t> next (begin_.begin (), begin_.end () - 1);
    points_.resize (chosen.size ());
    for (const std::uint32_t n : chosen)
      points_[next[cellOf (points[n])]++] = n;
  }

  /** \brief Whether \a predicate (n) holds for one of the points in the cells that a triangle touches. */
  template <typename Predicate> bool anyOf (const std::array<Point, 3>& triangle, const Predicate& predicate) const
  {
    const auto [low, high] = std::minmax ({triangle[0].y (), triangle[1].y (), triangle[2].y ()});
    for (int row = index (low, 1); row <= index (high, 1); ++row)
    {
      const auto [left, right] = reachInRow (triangle, row);
      const std::size_t first = static_cast<std::size_t> (row) * side_;
      const std::uint32_t end = begin_[first + index (right, 0) + 1];
      for (std::uint32_t k = begin_[first + index (left, 0)]; k < end; ++k)
        if (predicate (points_[k]))
          return true;
    }
    return false;
  }

private:
  int index (double value, int axis) const
  {
    if (!(cells_per_length_[axis] > 0.0))
      return 0;
    const double cell = (value - origin_[axis]) * cells_per_length_[axis];
    return static_cast<int> (std::clamp (cell, 0.0, side_ - 1.0));
  }

  std::size_t cellOf (const Point& p) const
  {
    return static_cast<std::size_t> (index (p.y (), 1)) * side_ + index (p.x (), 0);
  }

  /** \brief Least and largest x of a triangle in a row, which is taken a little higher than it is. */
  std::pair<double, double> reachInRow (const std::array<Point, 3>& triangle, int row) const
  {
    constexpr double rounding = 1e-6; // of a cell
    // What is beyond the first and the last row counts to them.
    const double height = cells_per_length_.y () > 0.0 ? 1.0 / cells_per_length_.y () : INFINITY;
    const bool first = row == 0, last = row == side_ - 1 || !std::isfinite (height);
    const double bottom = first ? -INFINITY : origin_.y () + (row - rounding) * height;
    const double top = last ? INFINITY : origin_.y () + (row + 1 + rounding) * height;
    double left = INFINITY, right = -INFINITY;
    const auto add = [&] (double x) {
      left = std::min (left, x);
      right = std::max (right, x);
    };
    for (int n = 0; n < 3; ++n)
    {
      const Point &a = triangle[n], &b = triangle[(n + 1) % 3];
      if (a.y () >= bottom && a.y () <= top)
        add (a.x ());
      for (const double y : {bottom, top})
        if (std::min (a.y (), b.y ()) < y && y < std::max (a.y (), b.y ()))
          add (a.x () + (b.x () - a.x ()) * (y - a.y ()) / (b.y () - a.y ()));
    }
    const double margin = cells_per_length_.x () > 0.0 ? rounding / cells_per_length_.x () : 0.0;
    return {left - margin, right + margin};
  }

  int side_;
  Point origin_ = Point::Zero ();
  Eigen::Array2d cells_per_length_ = Eigen::Array2d::Zero ();
  std::vector<std::uint32_t> begin_, points_;
};

class EarClipping
{
public:
  explicit EarClipping (const std::vector<Point>& polygon)
      : polygon_ (polygon)
      , size_ (static_cast<std::uint32_t> (polygon.size ()))
      , before_ (size_)
      , after_ (size_)
      , grid_ (polygon, notConvex ())
  {
    Eigen::AlignedBox2d box;
    for (const Point& p : polygon)
      box.extend (p);
    const double farthest = std::max (box.min ().cwiseAbs ().maxCoeff (), box.max ().cwiseAbs ().maxCoeff ());
    rounding_ = 16.0 * std::numeric_limits<double>::epsilon () * farthest * box.sizes ().maxCoeff ();
  }

  std::vector<std::array<std::uint32_t, 3>> triangles ()
  {
    std::vector<std::array<std::uint32_t, 3>> result;
    std::uint32_t left = size_;
    for (const bool straight_too : {false, true})
    {
      for (std::uint32_t n = 0; n < size_; ++n)
        if (!gone_[n])
          push (n);
      for (; left > 2 && !queue_.empty (); queue_.pop_front ())
      {
        const auto [n, turn_number] = queue_.front ();
        if (gone_[n] || turn_number != pushed_[n] || (left > 3 && !isEar (n, straight_too)))
          continue;
        result.push_back ({before_[n], n, after_[n]});
        cut (n);
        --left;
      }
      queue_.clear ();
    }
    if (left > 2)
      result.clear ();
    return result;
  }

private:
  /** \brief Link the corners, and return those whose angle is not convex: a cut makes an angle smaller, never larger.
   */
  std::vector<std::uint32_t> notConvex ()
  {
    std::vector<std::uint32_t> result;
    for (std::uint32_t n = 0; n < size_; ++n)
    {
      before_[n] = (n + size_ - 1) % size_;
      after_[n] = (n + 1) % size_;
    }
    for (std::uint32_t n = 0; n < size_; ++n)
      if (!(turn (n) > 0.0))
        result.push_back (n);
    gone_.assign (size_, false);
    pushed_.assign (size_, 0);
    convex_.assign (size_, true);
    for (const std::uint32_t n : result)
      convex_[n] = false;
    return result;
  }

  double turn (std::uint32_t n) const
  {
    return cross<double> (polygon_[n] - polygon_[before_[n]], polygon_[after_[n]] - polygon_[n]);
  }

  bool isEar (std::uint32_t n, bool straight_too) const
  {
    const double area = turn (n);
    if (straight_too ? area < -rounding_ : !(area > 0.0))
      return false;
    const std::array<Point, 3> corners = {polygon_[before_[n]], polygon_[n], polygon_[after_[n]]};
    return !grid_.anyOf (corners, [&] (std::uint32_t m) {
      const Point& p = polygon_[m];
      if (convex_[m] || p == corners[0] || p == corners[1] || p == corners[2])
        return false;
      for (int k = 0; k < 3; ++k)
        if (cross<double> (corners[(k + 1) % 3] - corners[k], p - corners[k]) < 0.0)
          return false;
      return true;
    });
  }

  /** \brief Try a corner after all others that wait: one after the other they would make slivers of a round polygon. */
  void push (std::uint32_t n) { queue_.emplace_back (n, ++pushed_[n]); }

  /** \brief Cut a corner off, after which only its neighbours may have become ears. */
  void cut (std::uint32_t n)
  {
    const std::uint32_t a = before_[n], b = after_[n];
    after_[a] = b;
    before_[b] = a;
    gone_[n] = convex_[n] = true; // it is in no ear any more
    for (const std::uint32_t m : {a, b})
    {
      convex_[m] = convex_[m] || turn (m) > 0.0;
      push (m);
    }
  }

  const std::vector<Point>& polygon_;
  std::uint32_t size_;
  double rounding_ = 0.0; ///< of an area, twice
  std::vector<std::uint32_t> before_, after_;
  std::vector<bool> gone_, convex_;
  std::vector<std::uint32_t> pushed_;                         ///< how often
  std::deque<std::pair<std::uint32_t, std::uint32_t>> queue_; ///< corners, and the how manieth time this is
  PointGrid grid_;
};

} // namespace

std::vector<std::array<std::uint32_t, 3>>
clipEars (const std::vector<Point>& polygon)
{
  if (polygon.size () < 3)
    return {};
  return EarClipping (polygon).triangles ();
}

} // namespace pcl::cosection
