// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Twice the area of the triangle 0, a, b; positive if b is counter-clockwise of a. */
template <typename Real>
Real
cross (const Eigen::Matrix<Real, 2, 1>& a, const Eigen::Matrix<Real, 2, 1>& b)
{
  return a.x () * b.y () - a.y () * b.x ();
}

/** \brief Corners of the convex hull, counter-clockwise (A. M. Andrew's monotone chain, 1979). O (n log n). */
template <typename Real>
std::vector<Eigen::Matrix<Real, 2, 1>>
convexHull (std::vector<Eigen::Matrix<Real, 2, 1>> points)
{
  using Point = Eigen::Matrix<Real, 2, 1>;
  if (points.empty ())
    return points;
  std::sort (points.begin (), points.end (),
             [] (const Point& a, const Point& b) { return a.x () < b.x () || (a.x () == b.x () && a.y () < b.y ()); });
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) // lower, upper
  {
    const std::size_t begin = hull.size ();
    for (const Point& p : points)
    {
      while (hull.size () >= begin + 2 &&
             cross<Real> (hull.back () - hull[hull.size () - 2], p - hull.back ()) <= Real (0))
        hull.pop_back ();
      hull.push_back (p);
    }
    hull.pop_back ();
    std::reverse (points.begin (), points.end ());
  }
  return hull;
}

/** \brief Whether a point is in a convex polygon whose corners are counter-clockwise, or on its border. */
template <typename Real>
bool
isInside (const std::vector<Eigen::Matrix<Real, 2, 1>>& polygon, const Eigen::Matrix<Real, 2, 1>& p)
{
  for (std::size_t n = 0; n < polygon.size (); ++n)
    if (cross<Real> (polygon[(n + 1) % polygon.size ()] - polygon[n], p - polygon[n]) < Real (0))
      return false;
  return !polygon.empty ();
}

} // namespace pcl::cosection
