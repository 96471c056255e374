// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "rounded_rectangle.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {

double
RoundedRectangle::distance (const Eigen::Vector2d& q) const
{
  const Eigen::Array2d beyond = q.array ().abs () - half_sizes_ + corner_; // relative to the centre of the corner
  return beyond.max (0.0).matrix ().norm () + std::min (beyond.maxCoeff (), 0.0) - corner_ + halfWidth ();
}

Eigen::Vector2d
RoundedRectangle::away (const Eigen::Vector2d& q) const
{
  const Eigen::Array2d beyond = q.array ().abs () - half_sizes_ + corner_;
  const Eigen::Array2d sense = (q.array () < 0.0).select (Eigen::Array2d::Constant (-1.0), Eigen::Array2d::Ones ());
  if ((beyond > 0.0).all ())
    return (sense * beyond).matrix ().normalized ();
  return beyond.x () > beyond.y () ? Eigen::Vector2d (sense.x (), 0.0) : Eigen::Vector2d (0.0, sense.y ());
}

double
RoundedRectangle::reach (const Eigen::Vector2d& n, double distance) const
{
  const double radius = corner_ + distance - halfWidth ();
  const Eigen::Array2d half = (half_sizes_ - corner_ + std::min (radius, 0.0)).max (0.0);
  return n.cwiseAbs ().dot (half.matrix ()) + std::max (radius, 0.0) * n.norm ();
}

std::vector<Eigen::Vector2d>
RoundedRectangle::outline (double distance, double step) const
{
  const double radius = corner_ + distance - halfWidth ();
  const Eigen::Array2d half = (half_sizes_ - corner_ + std::min (radius, 0.0)).max (0.0);
  const double arc = 0.5 * M_PI * std::max (radius, 0.0);
  std::vector<Eigen::Vector2d> points;
  for (int side = 0; side < 4; ++side)
  {
    const Eigen::Vector2d out (side == 0 ? 1.0 : side == 2 ? -1.0 : 0.0, side == 1 ? 1.0 : side == 3 ? -1.0 : 0.0);
    const Eigen::Vector2d along (-out.y (), out.x ());
    const double from = half[side % 2], length = half[1 - side % 2]; // distance and half length of the side
    const int steps = std::max (1, static_cast<int> (std::ceil (2.0 * length / step)));
    for (int i = 0; i < steps; ++i)
      points.push_back ((from + std::max (radius, 0.0)) * out + (2.0 * i / steps - 1.0) * length * along);
    const int turns = std::max (1, static_cast<int> (std::ceil (arc / step)));
    for (int i = 0; i < turns; ++i)
    {
      const double angle = 0.5 * M_PI * i / turns;
      points.push_back (from * out + length * along +
                        std::max (radius, 0.0) * (std::cos (angle) * out + std::sin (angle) * along));
    }
  }
  return points;
}

} // namespace pcl::cosection
