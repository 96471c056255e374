// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief A rectangle about the origin, along the axes, with rounded corners; and the outlines parallel to it, inside
 * and outside. */
class RoundedRectangle
{
public:
  RoundedRectangle () = default;

  /** \param[in] half_sizes positive \param[in] corner radius of the corners, at most the smaller of them */
  RoundedRectangle (const Eigen::Array2d& half_sizes, double corner) : half_sizes_ (half_sizes), corner_ (corner) {}

  /** \brief Its smaller half size, which is distance () on its outline. */
  double halfWidth () const { return half_sizes_.minCoeff (); }

  /** \brief Distance from its middle line: constant along parallel outlines, 0 on the middle line. */
  double distance (const Eigen::Vector2d& q) const;

  /** \brief The gradient of distance (), unit. */
  Eigen::Vector2d away (const Eigen::Vector2d& q) const;

  /** \brief Support function of the parallel outline at a distance, along \a n. */
  double reach (const Eigen::Vector2d& n, double distance) const;

  /** \brief Points of the parallel outline at a distance. */
  std::vector<Eigen::Vector2d> outline (double distance, double step) const;

private:
  Eigen::Array2d half_sizes_ = Eigen::Array2d::Zero ();
  double corner_ = 0.0;
};

} // namespace pcl::cosection
