// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/priors/shape/profile_surface.h"
#include "rounded_rectangle.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief What is hollow and has a rectangle as its outline, perhaps with rounded corners: a tray, a box without its
 * lid, a bin.
 *
 * Its walls are alike on all four sides. */
class OpenBox : public ProfileSurface
{
public:
  /** \brief Of the points of one body. \param[in] faces directions in which large parts of it face: without a plane,
   * its floor is one
   * \param[in] plane what it stands on, (n, d) with n.x + d = 0, unit n towards it
   * \return nothing if it is not hollow, or less than three quarters of the points belong to such walls and their floor
   */
  static std::optional<OpenBox> fit (const std::vector<OrientedPoint>& points,
                                     const std::vector<Eigen::Vector3d>& faces,
                                     const std::optional<Eigen::Vector4d>& plane);

  /** \brief Mirrored to the opposite sides. */
  std::vector<OrientedPoint> onOtherSides (const std::vector<OrientedPoint>& points) const override;

  std::shared_ptr<const ProfileSurface> withoutFloor () const override;

private:
  /** \brief As seen along its axis. */
  struct FlatPoint
  {
    Eigen::Vector2d position;
    Eigen::Vector2d normal; // not unit
  };

  OpenBox () = default;
  static std::optional<OpenBox> along (const Eigen::Vector3d& up, const std::vector<OrientedPoint>& points,
                                       const std::optional<Eigen::Vector4d>& plane);
  /** \brief About another axis, does it fit the same points better? */
  bool isBetter (const OpenBox& other) const;
  /** \brief Turns the axes along the walls and finds the outline. */
  bool findOutline (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane);
  bool findCorners (const std::vector<OrientedPoint>& points, const Eigen::Array2d& half_sizes);
  FlatPoint flat (const OrientedPoint& point) const;
  Eigen::Vector2d flat (const Eigen::Vector3d& q) const { return {x_.dot (q), y_.dot (q)}; }
  bool isAlongWall (const FlatPoint& point) const;
  double distanceOf (const Eigen::Vector3d& q) const override;
  Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const override;
  double reachOf (const Eigen::Vector3d& n, double distance) const override;
  std::vector<Place> around (double distance, double step_m) const override;

  Eigen::Vector3d x_ = Eigen::Vector3d::UnitX (), y_ = Eigen::Vector3d::UnitY (); // along its walls
  RoundedRectangle outline_;
  std::size_t walls_ = 0; // of which something was seen
};

} // namespace pcl::cosection
