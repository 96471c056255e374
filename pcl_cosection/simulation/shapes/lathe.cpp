// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "lathe.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int min_segments = 12;
constexpr int max_segments = 4096;

/** \brief Angle of a segment of a circle of \a radius, such that no chord is farther than \a chord_m from it. */
double
segmentAngle (double radius, double chord_m)
{
  const double cosine = 1.0 - std::min (chord_m / radius, 1.0);
  return std::clamp (2.0 * std::acos (cosine), 2.0 * M_PI / max_segments, 2.0 * M_PI / min_segments);
}

} // namespace

Polygon2d
arc (const Eigen::Vector2d& centre, double radius, double from_rad, double to_rad, double chord_m)
{
  const int steps = std::max (
      1, static_cast<int> (std::ceil (std::abs (to_rad - from_rad) / segmentAngle (radius, chord_m))));
  Polygon2d points;
  for (int n = 0; n <= steps; ++n)
  {
    const double angle = from_rad + (to_rad - from_rad) * n / steps;
    points.push_back (centre + radius * Eigen::Vector2d (std::cos (angle), std::sin (angle)));
  }
  return points;
}

TriangleMesh
turnedProfile (const Polygon2d& profile, bool closed, double chord_m)
{
  double radius = 0.0;
  for (const Eigen::Vector2d& p : profile)
    radius = std::max (radius, p.x ());
  const auto segments = static_cast<std::uint32_t> (std::ceil (2.0 * M_PI / segmentAngle (radius, chord_m)));
  TriangleMesh mesh;
  std::vector<std::uint32_t> first; // vertex of each point; one on the axis, else segments
  const auto onAxis = [&] (std::size_t n) { return profile[n].x () <= 0.0; };
  for (std::size_t n = 0; n < profile.size (); ++n)
  {
    first.push_back (static_cast<std::uint32_t> (mesh.vertices.size ()));
    for (std::uint32_t s = 0; s < (onAxis (n) ? 1u : segments); ++s)
    {
      const double angle = 2.0 * M_PI * s / segments;
      mesh.vertices.emplace_back (static_cast<float> (profile[n].x () * std::cos (angle)),
                                  static_cast<float> (profile[n].x () * std::sin (angle)),
                                  static_cast<float> (profile[n].y ()));
    }
  }
  for (std::size_t n = 0; n + (closed ? 0 : 1) < profile.size (); ++n)
  {
    const std::size_t m = (n + 1) % profile.size ();
    if (onAxis (n) && onAxis (m))
      continue;
    for (std::uint32_t s = 0; s < segments; ++s)
    {
      const std::uint32_t next = (s + 1) % segments;
      const std::uint32_t a = first[n] + (onAxis (n) ? 0 : s), b = first[n] + (onAxis (n) ? 0 : next);
      const std::uint32_t c = first[m] + (onAxis (m) ? 0 : next), d = first[m] + (onAxis (m) ? 0 : s);
      if (a != b)
        mesh.triangles.push_back ({a, b, c});
      if (c != d)
        mesh.triangles.push_back ({a, c, d});
    }
  }
  return mesh;
}

} // namespace pcl::cosection
