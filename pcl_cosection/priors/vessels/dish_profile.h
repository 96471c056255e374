// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "wall_profile.h"

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The profile of a plate or bowl that showed only its inside, and perhaps the edge: a wall of even thickness
 * below the inside.
 *
 * The wall is as thick as the floor is high above the support plane. If this height is unknown, or larger than crockery
 * is thick, the usual thickness of crockery is assumed. Below its floor a dish is solid down to the support plane. */
class DishProfile : public WallProfile
{
public:
  /** \brief Fit to profile points.
   * \param[in] points of the whole surface
   * \param[in] cell_m twice the length of the parts into which the profile is divided
   * \return nothing if there is no rising border around a horizontal floor, or if more than the inside and the edge was
   * seen */
  static std::shared_ptr<const DishProfile> find (const std::vector<ProfilePoint>& points, double cell_m,
                                                  const std::optional<StandingPlane>& plane);

  double wallThickness () const override { return wall_m_; }

  /** \brief A copy of this: a dish always has a floor, as it was seen. */
  std::shared_ptr<const WallProfile> withoutFloor () const override { return std::make_shared<DishProfile> (*this); }

  VesselPart partOf (const ProfilePoint& point) const override;

  std::vector<ProfilePoint> depths (double step_m) const override;

  bool holds (const ProfilePoint& point) const override;

  double depthInCavity (const Eigen::Vector2d& position) const override;

  double depthUnder (const Eigen::Vector2d& position) const override;

private:
  /** \brief A place of the inside, with its height above the bottom, and its normal. */
  struct Place
  {
    Eigen::Vector2d position;
    Eigen::Vector2d normal;
  };

  /** \brief Whether the border rises more steeply than that of crockery. \param[in] rim height */
  bool isGrazing (double rim) const;
  bool findInside (const std::vector<ProfilePoint>& points, double step_m);
  Eigen::Vector2d vertical (const Eigen::Vector2d& profile) const { return {up_ * profile.x (), profile.y ()}; }
  /** \brief Height of a place above the inside, negative below it. */
  double heightOver (const Eigen::Vector2d& position) const;

  double up_ = 1.0;           // 1 or -1: the sense of the axis that is upwards
  std::vector<Place> inside_; // from the axis outwards to the edge
  Eigen::Vector2d outwards_;  // direction of the inside at the edge
  double wall_m_ = 0.0;
  double noise_m_ = 0.0; // largest distance of points from a side
  double floor_m_ = 0.0; // heights
  double bottom_m_ = 0.0;
  double foot_m_ = 0.0; // radius of the floor
};

} // namespace pcl::cosection
