// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_axis.h"
#include "profile_surface.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A surface of revolution: a bottle, a can, a bowl, a ball, a mug without its handle. */
class SurfaceOfRevolution : public ProfileSurface
{
public:
  /** \brief Fit to the points of one body.
   * \param[in] plane support plane (n, d) with n.x + d = 0, unit n towards the body: an axis along n is preferred to
   * others that are about as good
   * \param[in] alone its surroundings are unknown: without a plane, the rim of a dish may determine the axis
   * \return nothing if less than three quarters of the points belong to such a surface, or less than 70 degrees of it
   * were seen. For a plate, which hardly faces sideways, a round outline as seen from above suffices */
  static std::optional<SurfaceOfRevolution> fit (const std::vector<OrientedPoint>& points,
                                                 const std::optional<Eigen::Vector4d>& plane, bool alone = true);

  bool isBall () const override { return is_ball_; }

  /** \brief Copies of the points turned about the axis. */
  std::vector<OrientedPoint> onOtherSides (const std::vector<OrientedPoint>& points) const override;

  std::vector<OrientedPoint> flatEnds () const override;

  std::shared_ptr<const ProfileSurface> withoutFloor () const override;

private:
  /** \brief Fit with a known axis.
   * \param[in] least_sectors around the axis, next to each other, in which points must face sideways
   * \return nothing if too few points belong to the surface */
  static std::optional<SurfaceOfRevolution> about (const Axis& axis, const NormalLines& normals,
                                                   const std::vector<OrientedPoint>& points,
                                                   const std::optional<Eigen::Vector4d>& plane, int least_sectors,
                                                   Hollow hollow);
  double distanceOf (const Eigen::Vector3d& q) const override;
  Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const override;
  double reachOf (const Eigen::Vector3d& n, double distance) const override;
  std::vector<Place> around (double distance, double step_m) const override;
  /** \brief Largest radius of the profile, metres. */
  double radius () const;

  bool is_ball_ = false;
};

} // namespace pcl::cosection
