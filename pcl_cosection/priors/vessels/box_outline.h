// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A point in the frame of an open box: x and y along its walls, z upwards. */
struct BoxPoint
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

struct BoxOutline
{
  Eigen::Array2d middle;
  Eigen::Array2d half_sizes;
  std::size_t walls; // number of walls that were seen
};

/** \brief The outline of an open box: the outer sides of its walls, at half height. An unseen outer side is as far from
 * the inner side as other walls, or the floor, are thick.
 * \param[in] points relative to a middle near the origin, heights from the middle of the walls
 * \param[in] half_sizes approximate
 * \param[in] bottom height, if known
 * \return nothing if a wall is missing, or less than two were seen from inside */
std::optional<BoxOutline> outlineByWalls (const std::vector<BoxPoint>& points, const Eigen::Array2d& half_sizes,
                                          const std::optional<double>& bottom);

/** \brief A rectangle about the origin, along the axes; and the outlines parallel to it, inside and outside. */
class RectangularOutline
{
public:
  RectangularOutline () = default;

  /** \param[in] half_sizes positive */
  explicit RectangularOutline (const Eigen::Array2d& half_sizes) : half_sizes_ (half_sizes) {}

  /** \brief Distance from its middle line: constant along parallel outlines, 0 on the middle line, and the smaller half
   * size on its outline. */
  double distance (const Eigen::Vector2d& q) const;

  /** \brief The gradient of distance (), unit. */
  Eigen::Vector2d away (const Eigen::Vector2d& q) const;

  /** \brief Support function of the parallel outline at a distance, along \a n. */
  double reach (const Eigen::Vector2d& n, double distance) const
  {
    return n.cwiseAbs ().dot (halfSizesAt (distance).matrix ());
  }

  /** \brief Points of the parallel outline at a distance. */
  std::vector<Eigen::Vector2d> outline (double distance, double step) const;

private:
  Eigen::Array2d halfSizesAt (double distance) const
  {
    return (half_sizes_ + distance - half_sizes_.minCoeff ()).max (0.0);
  }

  Eigen::Array2d half_sizes_ = Eigen::Array2d::Zero ();
};

} // namespace pcl::cosection
