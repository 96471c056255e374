// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"
#include "profile_surface.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief What is round about some axis: a bottle, a can, a bowl, a ball, a mug but for its handle. */
class SurfaceOfRevolution : public ProfileSurface
{
public:
  /** \brief Of the points of one body. \param[in] plane what it stands on, (n, d) with n.x + d = 0, unit n towards it:
   * an axis along n is preferred to others that are about as good
   * \param[in] alone nothing around it is known: without a plane, a dish may be told by its rim
   * \return nothing if less than three quarters of the points belong to such a surface, or less than 70 degrees were
   * seen of it; but a plate, which hardly faces sideways, may be round as seen from above */
  static std::optional<SurfaceOfRevolution> fit (const std::vector<OrientedPoint>& points,
                                                 const std::optional<Eigen::Vector4d>& plane, bool alone = true);

  bool isBall () const override { return is_ball_; }

  /** \brief Turned about the axis. */
  std::vector<OrientedPoint> onOtherSides (const std::vector<OrientedPoint>& points) const override;

  std::vector<OrientedPoint> flatEnds () const override;

  std::shared_ptr<const ProfileSurface> withoutFloor () const override;

private:
  /** \brief About a known axis. \param[in] least_sectors around it in a row, in which points face sideways \return
   * nothing if too few belong to it */
  static std::optional<SurfaceOfRevolution> about (const Axis& axis, const NormalLines& normals,
                                                   const std::vector<OrientedPoint>& points,
                                                   const std::optional<Eigen::Vector4d>& plane, int least_sectors,
                                                   Hollow hollow);
  double distanceOf (const Eigen::Vector3d& q) const override;
  Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const override;
  double reachOf (const Eigen::Vector3d& n, double distance) const override;
  std::vector<Place> around (double distance, double step_m) const override;
  /** \brief Of all that is round, metres. */
  double radius () const;

  bool is_ball_ = false;
};

} // namespace pcl::cosection
