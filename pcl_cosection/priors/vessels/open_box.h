// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/shape/profile_surface.h"
#include "rounded_rectangle.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief An open box: a hollow thing with a rectangular outline, perhaps with rounded corners, such as a tray, a box
 * without lid or a bin. Its walls are equal on all four sides. */
class OpenBox : public ProfileSurface
{
public:
  /** \brief Fit to the points of one body.
   * \param[in] faces normals of its large faces: without a plane, the floor is one of them
   * \param[in] plane support plane (n, d) with n.x + d = 0, unit n towards the body
   * \return nothing if it is not hollow, or less than three quarters of the points belong to such walls and their floor
   */
  static std::optional<OpenBox> fit (const std::vector<OrientedPoint>& points,
                                     const std::vector<Eigen::Vector3d>& faces,
                                     const std::optional<Eigen::Vector4d>& plane);

  /** \brief Reflections of the points in the middle planes. */
  std::vector<OrientedPoint> onOtherSides (const std::vector<OrientedPoint>& points) const override;

  std::shared_ptr<const ProfileSurface> withoutFloor () const override;

private:
  /** \brief A point projected along the axis. */
  struct FlatPoint
  {
    Eigen::Vector2d position;
    Eigen::Vector2d normal; // not unit
  };

  OpenBox () = default;
  static std::optional<OpenBox> along (const Eigen::Vector3d& up, const std::vector<OrientedPoint>& points,
                                       const std::optional<Eigen::Vector4d>& plane);
  /** \brief Whether it fits the same points better than a box about another axis. */
  bool isBetter (const OpenBox& other) const;
  /** \brief Align the axes with the walls and find the outline. */
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
  std::size_t walls_ = 0; // number of walls that were seen
};

} // namespace pcl::cosection
