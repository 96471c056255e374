// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "polygon.h"

#include "pcl_cosection/common/convex_hull.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double min_area_m2 = 1e-12;
constexpr int min_segments = 12; // of a circle
constexpr int max_segments = 4096;
constexpr std::size_t max_points = 10000; // each distance looks at all

/** \brief Whether two segments share a point. */
bool
touch (const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d)
{
  const auto side = [] (double value) { return (value > 0.0) - (value < 0.0); };
  const auto onSegment = [] (const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (r.array () >= p.cwiseMin (q).array ()).all () && (r.array () <= p.cwiseMax (q).array ()).all ();
  };
  const int abc = side (cross<double> (b - a, c - a)), abd = side (cross<double> (b - a, d - a));
  const int cda = side (cross<double> (d - c, a - c)), cdb = side (cross<double> (d - c, b - c));
  if (abc != abd && cda != cdb)
    return true;
  return (abc == 0 && onSegment (a, b, c)) || (abd == 0 && onSegment (a, b, d)) || (cda == 0 && onSegment (c, d, a)) ||
         (cdb == 0 && onSegment (c, d, b));
}

} // namespace

Polygon2d
arc (const Eigen::Vector2d& centre, double radius, double from_rad, double to_rad, double chord_m)
{
  const double cosine = 1.0 - std::min (chord_m / radius, 1.0);
  const double segment_rad = std::clamp (2.0 * std::acos (cosine), 2.0 * M_PI / max_segments,
                                         2.0 * M_PI / min_segments);
  const int steps = std::max (1, static_cast<int> (std::ceil (std::abs (to_rad - from_rad) / segment_rad)));
  Polygon2d points;
  for (int n = 0; n <= steps; ++n)
  {
    const double angle = from_rad + (to_rad - from_rad) * n / steps;
    points.push_back (centre + radius * Eigen::Vector2d (std::cos (angle), std::sin (angle)));
  }
  return points;
}

Polygon2d
simplePolygon (Polygon2d polygon, const char* what)
{
  const auto refuse = [what] (const std::string& why) { throw InvalidArgument (std::string (what) + " " + why); };
  const std::size_t size = polygon.size ();
  if (size < 3)
    refuse ("must have at least three points");
  if (size > max_points)
    refuse ("must have at most " + std::to_string (max_points) + " points");
  for (const Eigen::Vector2d& p : polygon)
    if (!p.allFinite ())
      refuse ("must have finite points");
  for (std::size_t n = 0; n < size; ++n)
    if (polygon[n] == polygon[(n + 1) % size])
      refuse ("has point " + std::to_string (n) + " twice in a row");
  for (std::size_t n = 0; n < size; ++n)
  {
    for (std::size_t m = n + 2; m < size; ++m)
      if ((m + 1) % size != n && touch (polygon[n], polygon[n + 1], polygon[m], polygon[(m + 1) % size]))
        refuse ("crosses or touches itself: its edges " + std::to_string (n) + " and " + std::to_string (m));
    const Eigen::Vector2d back = polygon[n] - polygon[(n + 1) % size];
    const Eigen::Vector2d on = polygon[(n + 2) % size] - polygon[(n + 1) % size];
    if (cross<double> (back, on) == 0.0 && back.dot (on) > 0.0)
      refuse ("turns back on itself at point " + std::to_string ((n + 1) % size));
  }
  double area = 0.0; // positive if counter-clockwise
  for (std::size_t n = 0; n < size; ++n)
    area += cross<double> (polygon[n], polygon[(n + 1) % size]);
  area *= 0.5;
  if (!(std::abs (area) > min_area_m2))
    refuse ("has no area");
  if (area < 0.0)
    std::reverse (polygon.begin (), polygon.end ());
  return polygon;
}

double
polygonDistance (const Polygon2d& polygon, const Eigen::Vector2d& p, bool open_at_axis)
{
  double squared = std::numeric_limits<double>::infinity ();
  bool inside = false;
  for (std::size_t n = 0; n < polygon.size (); ++n)
  {
    const Eigen::Vector2d& a = polygon[n];
    const Eigen::Vector2d& b = polygon[(n + 1) % polygon.size ()];
    if ((a.y () > p.y ()) != (b.y () > p.y ()) &&
        p.x () < a.x () + (b.x () - a.x ()) * (p.y () - a.y ()) / (b.y () - a.y ()))
      inside = !inside;
    if (open_at_axis && a.x () == 0.0 && b.x () == 0.0)
      continue;
    const Eigen::Vector2d along = b - a;
    const double t = std::clamp ((p - a).dot (along) / along.squaredNorm (), 0.0, 1.0);
    squared = std::min (squared, (a + t * along - p).squaredNorm ());
  }
  return (inside ? -1.0 : 1.0) * std::sqrt (squared);
}

} // namespace pcl::cosection
