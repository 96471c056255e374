// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/common/ear_clipping.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

using namespace pcl::cosection;

namespace {

using Polygon = std::vector<Eigen::Vector2d>;

/** \brief Corners at radii from a function, counter-clockwise. */
template <typename Radius>
Polygon
around (int corners, const Radius& radius)
{
  Polygon polygon;
  for (int n = 0; n < corners; ++n)
  {
    const double angle = 2.0 * M_PI * n / corners;
    polygon.push_back (radius (n) * Eigen::Vector2d (std::cos (angle), std::sin (angle)));
  }
  return polygon;
}

double
areaOf (const Polygon& polygon)
{
  double twice = 0.0;
  for (std::size_t n = 0; n < polygon.size (); ++n)
    twice += cross<double> (polygon[n], polygon[(n + 1) % polygon.size ()]);
  return 0.5 * twice;
}

/** \brief All edges of the polygon, and each inner edge in both directions; so the triangles cover it as a disk. */
void
expectCovered (const Polygon& polygon)
{
  const auto triangles = clipEars (polygon);
  ASSERT_EQ (triangles.size (), polygon.size () - 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  double area = 0.0;
  for (const auto& t : triangles)
  {
    const double part = areaOf ({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    EXPECT_GE (part, 0.0);
    area += part;
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE (edges.insert ({t[k], t[(k + 1) % 3]}).second);
  }
  EXPECT_NEAR (area, areaOf (polygon), 1e-9 * area); // none overlaps another
  const auto size = static_cast<std::uint32_t> (polygon.size ());
  for (std::uint32_t n = 0; n < size; ++n)
    EXPECT_TRUE (edges.erase ({n, (n + 1) % size}));
  for (const auto& [a, b] : edges)
    EXPECT_TRUE (edges.count ({b, a}));
}

/** \brief A wall of unit thickness that winds inward: no corner sees far. */
Polygon
spiral (int turns)
{
  Polygon outer, inner;
  for (int n = 0; n <= 40 * turns; ++n)
  {
    const double angle = 2.0 * M_PI * n / 40.0, radius = 4.0 + 2.0 * angle / (2.0 * M_PI);
    outer.emplace_back ((radius + 1.0) * std::cos (angle), (radius + 1.0) * std::sin (angle));
    inner.emplace_back (radius * std::cos (angle), radius * std::sin (angle));
  }
  outer.insert (outer.end (), inner.rbegin (), inner.rend ());
  return outer;
}

} // namespace

TEST (EarClipping, PolygonsOfManyKinds)
{
  expectCovered ({{0, 0}, {1, 0}, {0, 1}});
  expectCovered (around (7, [] (int) { return 1.0; }));
  expectCovered (around (1000, [] (int n) { return n % 2 ? 0.5 : 1.5; }));
  expectCovered (spiral (12));
  Polygon comb = {{400, -1}, {400, 0}};
  for (int n = 200; n-- > 0;)
  {
    comb.emplace_back (2 * n + 1, 0);
    comb.emplace_back (2 * n + 0.5, 1000);
    comb.emplace_back (2 * n, 0);
  }
  comb.emplace_back (0, -1);
  expectCovered (comb);
}

TEST (EarClipping, StarShapedPolygonsAtRandom)
{
  std::mt19937 random (3);
  std::uniform_real_distribution<double> radius (0.01, 1.0);
  for (int n = 0; n < 200; ++n)
    expectCovered (around (3 + n, [&] (int) { return radius (random); }));
}

TEST (EarClipping, NotConvexCornersOnALine)
{
  std::mt19937 random (5);
  for (int n = 0; n < 400; ++n)
  {
    // Towers of few heights on a wall, turned; in some directions the line is straight but for rounding errors.
    const int towers = 2 + n % 13, heights = 1 + n % 3;
    Polygon wall = {{0, -0.3}, {2.0 * towers + 1.0, -0.3}};
    for (int tower = towers; tower-- > 0;)
    {
      const double height = 0.1 + 0.2 * static_cast<double> (random () % heights);
      const double right = 2.0 * tower + 1.0 + (tower + 1 == towers ? 1.0 : 0.0);
      wall.insert (wall.end (), {{right, height}, {right - 0.7, height}, {right - 0.7, 0.0}});
      if (tower > 0)
        wall.emplace_back (2.0 * tower, 0.0);
    }
    wall.emplace_back (0.0, 0.0);
    const Eigen::Rotation2Dd turn (n % 8 * M_PI_4);
    for (Eigen::Vector2d& corner : wall)
      corner = n % 16 < 8 ? Eigen::Vector2d (turn * corner)
                          : Eigen::Vector2d ((turn * corner) + Eigen::Vector2d (400.0, 5.3e6));
    EXPECT_EQ (clipEars (wall).size (), wall.size () - 2) << n;
  }
}

TEST (EarClipping, CornersOnStraightEdgesAndTwice)
{
  Polygon square;
  for (int side = 0; side < 4; ++side)
    for (int n = 0; n < 5; ++n)
    {
      const Eigen::Rotation2Dd turn (side * M_PI / 2.0);
      square.push_back (turn * Eigen::Vector2d (1.0, n / 2.5 - 1.0));
    }
  expectCovered (square);
  square.insert (square.begin () + 7, square[7]);
  EXPECT_EQ (clipEars (square).size (), square.size () - 2);
}

TEST (EarClipping, AHoleWithABridge)
{
  // The bridge from (0, 0) to (1, 1) belongs to the polygon twice.
  const Polygon polygon = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  const auto triangles = clipEars (polygon);
  ASSERT_EQ (triangles.size (), polygon.size () - 2);
  double area = 0.0;
  for (const auto& t : triangles)
  {
    area += areaOf ({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    const Eigen::Vector2d middle = (polygon[t[0]] + polygon[t[1]] + polygon[t[2]]) / 3.0;
    EXPECT_FALSE ((middle.array () > 1.0).all () && (middle.array () < 3.0).all ()) << middle.transpose ();
  }
  EXPECT_NEAR (area, 12.0, 1e-12);
}

TEST (EarClipping, CoordinatesOfAnySizeAreIndexed)
{
  for (const double scale : {1e-323, 1e-310, 1e-160, 1e-3, 1e150, 1e300, 1e308})
    for (const double across : {1.0, 1e-5})
    {
      Polygon star = around (12, [] (int n) { return n % 2 ? 0.3 : 1.0; });
      for (Eigen::Vector2d& p : star)
        p = Eigen::Vector2d (p.x () * scale, p.y () * across * scale);
      const std::size_t triangles = clipEars (star).size ();
      if (scale > 1e-100 && scale < 1e100)
      {
        EXPECT_EQ (triangles, star.size () - 2) << scale;
      }
      for (const auto& triangle : clipEars (star))
        for (const std::uint32_t corner : triangle)
          EXPECT_LT (corner, star.size ());
    }
}

TEST (EarClipping, CrossingsAreToldAndSmallPolygonsHaveNoTriangles)
{
  EXPECT_TRUE (clipEars ({}).empty ());
  EXPECT_TRUE (clipEars ({{0, 0}, {1, 0}}).empty ());
  EXPECT_TRUE (clipEars ({{0, 0}, {0, 1}, {1, 1}, {1, 0}}).empty ()); // clockwise
  EXPECT_TRUE (clipEars (around (10, [] (int n) { return n % 2 ? -0.2 : 1.0; })).empty ());
}
