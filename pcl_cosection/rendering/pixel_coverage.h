// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pcl::cosection {

/** \brief Pixel coordinates in 1/256 of a pixel: coverage is decided in exact integer arithmetic. */
struct SubpixelPoint
{
  static constexpr int subpixels = 256;

  std::int64_t x = 0;
  std::int64_t y = 0;

  static SubpixelPoint fromPixel (const Eigen::Vector2d& pixel)
  {
    return {std::llround (pixel.x () * subpixels), std::llround (pixel.y () * subpixels)};
  }
};

/** \brief Call visit (u, v) for every pixel of a width * height picture whose centre lies in the
 * triangle, whichever its orientation.
 *
 * A centre exactly on a side belongs to the triangle to whose left or top the side is: of two
 * triangles that share it, just one covers the pixel (J. Pineda, "A Parallel Algorithm for Polygon
 * Rasterization", SIGGRAPH 1988). */
template <typename Visit>
void
forEachCoveredPixel (SubpixelPoint a, SubpixelPoint b, SubpixelPoint c, int width, int height, Visit&& visit)
{
  const auto twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (twice_area == 0)
    return;
  if (twice_area < 0)
    std::swap (b, c);

  // value (x, y) = dx y - dy x + constant >= 0 on the inner side
  struct SideFunction
  {
    SideFunction (const SubpixelPoint& p, const SubpixelPoint& q)
        : step_u (-(q.y - p.y) * SubpixelPoint::subpixels)
        , step_v ((q.x - p.x) * SubpixelPoint::subpixels)
        , constant ((q.y - p.y) * p.x - (q.x - p.x) * p.y)
    {
      const bool owns_points_on_it = q.y < p.y || (q.y == p.y && q.x > p.x);
      if (!owns_points_on_it)
        --constant;
    }

    std::int64_t at (int u, int v) const { return constant + step_u * u + step_v * v; }

    std::int64_t step_u;
    std::int64_t step_v;
    std::int64_t constant;
  };
  const SideFunction ab (a, b);
  const SideFunction bc (b, c);
  const SideFunction ca (c, a);

  const auto firstCentre = [] (std::int64_t x) { // the least pixel whose centre is not before x
    return static_cast<int> (std::ceil (static_cast<double> (x) / SubpixelPoint::subpixels));
  };
  const auto lastCentre = [] (std::int64_t x) {
    return static_cast<int> (std::floor (static_cast<double> (x) / SubpixelPoint::subpixels));
  };
  const int u_begin = std::max (0, firstCentre (std::min ({a.x, b.x, c.x})));
  const int v_begin = std::max (0, firstCentre (std::min ({a.y, b.y, c.y})));
  const int u_last = std::min (width - 1, lastCentre (std::max ({a.x, b.x, c.x})));
  const int v_last = std::min (height - 1, lastCentre (std::max ({a.y, b.y, c.y})));
  for (int v = v_begin; v <= v_last; ++v)
  {
    std::int64_t e_ab = ab.at (u_begin, v);
    std::int64_t e_bc = bc.at (u_begin, v);
    std::int64_t e_ca = ca.at (u_begin, v);
    for (int u = u_begin; u <= u_last; ++u)
    {
      if ((e_ab | e_bc | e_ca) >= 0)
        visit (u, v);
      e_ab += ab.step_u;
      e_bc += bc.step_u;
      e_ca += ca.step_u;
    }
  }
}

} // namespace pcl::cosection
