// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/mesh_distance/sign_bricks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl::cosection {

/** \brief origin + t direction for 0 <= t <= end; voxel coordinates, within the voxels' box whatever is rounded. */
struct GridRay
{
  std::array<float, 3> origin;
  std::array<float, 3> direction;
  float end;
  float step; ///< for which the coordinate that changes most changes by one

  std::array<float, 3> at (float t) const
  {
    return {origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]};
  }
};

/** \brief Finds surfaces along rays. \a field must have two voxels along each axis at least. */
class RayMarch
{
public:
  using Point = std::array<float, 3>; // voxel coordinates

  /** \brief How far rays must stay away from the faces of the box. */
  static double margin (const VoxelGrid& grid)
  {
    constexpr double rounding = 1e-6; // of a coordinate of a ray
    return rounding * grid.dims.maxCoeff () + 1e-4;
  }

  RayMarch (const SignedDistanceField& field, const SignBricks& bricks)
      : values_ (field.values.data ())
      , bricks_ (bricks)
      , row_ (field.grid.dims.x ())
      , slice_ (row_ * field.grid.dims.y ())
  {}

  /** \brief Where the field first passes from positive values to others, if accept (t) says so; NaN: nowhere.
   *
   * Bricks at the distance n > 1 are passed n - 1 at once. At the distance 1 a step leads no farther than a voxel into
   * one with both signs, from where one step back is looked at, too. A step that cuts off a brick's corner misses no
   * surface: what is before the corner and what is behind it share the voxels at the corner, so that both have the same
   * sign. */
  template <typename Accept> float firstSurface (const GridRay& ray, Accept&& accept) const
  {
    bool known = false;   // whether before is the value at t_before
    bool refused = false; // the ray is behind a surface that was not accepted
    float t_before = 0.0f;
    float before = none;
    float t = 0.0f;
    while (true)
    {
      const Point p = ray.at (t);
      const int distance = bricks_.distanceAt (cell (p[0]), cell (p[1]), cell (p[2]));
      if (distance == 0 || known) // the first sample behind bricks with both signs belongs to them
      {
        if (!known)
          before = sample (ray.at (t_before = std::max (0.0f, t - ray.step)));
        const float value = sample (p);
        if (before > 0.0f && value <= 0.0f)
        {
          const float surface = refine (ray, t_before, before, t, value);
          if (!std::isnan (surface) && accept (surface))
            return surface;
          refused = true;
        }
        else if (before <= 0.0f && value > 0.0f)
        {
          if (!refused)
            return none; // out of the back of something
          refused = false;
        }
        t_before = t;
        before = value;
        known = (distance == 0);
      }
      if (t >= ray.end)
        return none;
      const int voxels = (distance > 1 ? (distance - 1) * SignBricks::edge : 1);
      t = std::min (t + static_cast<float> (voxels) * ray.step, ray.end);
    }
  }

  /** \brief Trilinear, within the voxels' box without its far faces; NaN next to an unknown voxel. */
  float sample (const Point& p) const
  {
    const std::ptrdiff_t i = cell (p[0]);
    const std::ptrdiff_t j = cell (p[1]);
    const std::ptrdiff_t k = cell (p[2]);
    const float* c = values_ + (k * slice_ + j * row_ + i);
    const float fx = p[0] - static_cast<float> (i);
    const float fy = p[1] - static_cast<float> (j);
    const float fz = p[2] - static_cast<float> (k);
    const float near = mix (mix (c[0], c[1], fx), mix (c[row_], c[row_ + 1], fx), fy);
    c += slice_;
    const float far = mix (mix (c[0], c[1], fx), mix (c[row_], c[row_ + 1], fx), fy);
    return mix (near, far, fz);
  }

private:
  static constexpr float none = std::numeric_limits<float>::quiet_NaN ();

  static float mix (float a, float b, float t) { return a + t * (b - a); }

  static std::ptrdiff_t cell (float x) { return static_cast<std::ptrdiff_t> (x); }

  /** \brief Zero between \a a, where the field is positive, and \a b; NaN: something is unknown between. */
  float refine (const GridRay& ray, float a, float at_a, float b, float at_b) const
  {
    const float t = a + (b - a) * (at_a / (at_a - at_b));
    const float at_t = sample (ray.at (t));
    if (at_t > 0.0f)
      return t + (b - t) * (at_t / (at_t - at_b));
    return a + (t - a) * (at_a / (at_a - at_t)); // NaN if at_t is
  }

  const float* values_;
  const SignBricks& bricks_;
  std::ptrdiff_t row_;
  std::ptrdiff_t slice_;
};

} // namespace pcl::cosection
