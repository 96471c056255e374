// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace pcl::cosection {

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
