// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/oriented_point.h>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief What is round about some axis: a bottle, a can, a bowl, a ball, a mug but for its handle. */
class SurfaceOfRevolution
{
public:
  /** \brief Of the points of one body. \param[in] plane what it stands on, (n, d) with n.x + d = 0, unit n towards it: an axis along n is
   * preferred to others that are about as good
   * \return nothing if less than three quarters of the points belong to such a surface, or less than 70 degrees were seen of it */
  static std::optional<SurfaceOfRevolution>
  fit (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane);

  /** \brief A point of the axis, in the middle of what was seen along it. */
  const Eigen::Vector3d&
  center () const
  {
    return center_;
  }

  /** \brief Unit direction of the axis. */
  const Eigen::Vector3d&
  direction () const
  {
    return direction_;
  }

  /** \brief Does a point lie on what is round, in any direction from the axis? */
  bool
  holds (const Eigen::Vector3d& position) const;

  /** \brief Farthest along \a n of all that is round, from the point \a center () on; metres. */
  double
  extent (const Eigen::Vector3d& n) const;

  /** \brief Copies of those of the points that lie on what is round, turned about the axis to all sides. */
  std::vector<OrientedPoint>
  turned (const std::vector<OrientedPoint>& points) const;

  /** \brief Flat faces at those ends of the axis to which a straight wall leads: the bottom of a can that stood on a table. */
  std::vector<OrientedPoint>
  flatEnds () const;

private:
  struct ProfilePoint
  {
    Eigen::Vector2d position; // height along the axis, distance from it
    double along;             // component of the normal along the axis
  };

  SurfaceOfRevolution () = default;
  bool
  findProfile (const std::vector<OrientedPoint>& points, double size);
  Eigen::Vector2i
  cellOf (const Eigen::Vector2d& profile) const;
  std::size_t
  indexOf (const Eigen::Vector2i& cell) const;
  Eigen::Vector2d
  profileOf (const Eigen::Vector3d& position) const; // height along the axis, distance from it

  Eigen::Vector3d center_;
  Eigen::Vector3d direction_;
  double cell_m_ = 0.0; // edge of the cells of the profile
  Eigen::Vector2i cells_;
  Eigen::Vector2d first_; // of all cells, height and distance
  std::vector<std::uint8_t> round_; // by cell
  std::vector<ProfilePoint> profile_; // of the points that are round
};

} // namespace cosection
} // namespace pcl
