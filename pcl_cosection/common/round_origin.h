// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {

/** \brief What single precision loses of the coordinates of a place. */
inline double
roundingAt (const Eigen::Vector3d& place)
{
  return place.cwiseAbs ().maxCoeff () * std::numeric_limits<float>::epsilon ();
}

/** \brief Whether floats would lose details of a mesh: vertices that are a thousandth of an edge apart, the least that
 * extractIsoSurface () gives, may become one.
 * \param[in] longest side of its box \param[in] spacing of the points it is of */
inline bool
needsLocalOrigin (const Eigen::Vector3d& centre, double longest, double spacing)
{
  constexpr double most_rounding = 1.0 / 1024; // of an edge
  constexpr double finest = 1.0 / 128;         // edge, of the longest side, even of denser points
  return roundingAt (centre) > most_rounding * std::max (spacing, finest * longest);
}

/** \brief A place near \a centre, of round numbers. */
inline Eigen::Vector3d
roundOrigin (const Eigen::Vector3d& centre, double longest)
{
  const double unit = std::pow (10.0, std::ceil (std::log10 (longest)));
  return unit * (centre / unit).array ().round ().matrix ();
}

} // namespace pcl::cosection
