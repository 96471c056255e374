// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl::cosection {

/** \brief Number, below \a count, of the sector of the plane to which (x, y) points. */
inline std::size_t
sectorOf (double x, double y, std::size_t count)
{
  const double turn = std::atan2 (y, x) / (2.0 * M_PI) + 0.5; // [0, 1]
  return std::min (static_cast<std::size_t> (turn * static_cast<double> (count)), count - 1);
}

/** \brief Equal sectors around an axis. */
class Sectors
{
public:
  /** \param[in] axis unit */
  Sectors (const Eigen::Vector3d& axis, std::size_t count)
      : x_ (axis.unitOrthogonal ())
      , y_ (axis.cross (x_))
      , count_ (count)
  {}

  /** \brief Number, below the count, of the sector to which a vector from the axis points. */
  std::size_t of (const Eigen::Vector3d& q) const { return sectorOf (x_.dot (q), y_.dot (q), count_); }

private:
  Eigen::Vector3d x_, y_; // across the axis
  std::size_t count_;
};

/** \brief The n-th of \a count directions that are evenly spread over the sphere (Fibonacci lattice). */
inline Eigen::Vector3f
sphereDirection (int n, int count)
{
  const double golden_angle = M_PI * (3.0 - std::sqrt (5.0));
  const double z = 1.0 - (2.0 * n + 1.0) / count;
  const double r = std::sqrt (1.0 - z * z);
  return Eigen::Vector3d (r * std::cos (golden_angle * n), r * std::sin (golden_angle * n), z).cast<float> ();
}

} // namespace pcl::cosection
