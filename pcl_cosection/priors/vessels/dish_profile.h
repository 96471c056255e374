// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "wall_profile.h"

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief The profile of a plate or bowl of which nothing but the inside was seen, and perhaps the edge: a wall of even
 * thickness below it.
 *
 * The wall is as thick as the floor is high above what the dish stands on, as far as crockery is; if that is more, or
 * is not known, as that of usual crockery. Under its floor a dish is filled, down to what it stands on. */
class DishProfile : public WallProfile
{
public:
  /** \param[in] points of the whole surface \param[in] cell_m twice the length of the parts into which the profile is
   * divided
   * \return nothing if it does not rise about a level floor, or more was seen of it than the inside of such a wall */
  static std::shared_ptr<const DishProfile> find (const std::vector<ProfilePoint>& points, double cell_m,
                                                  const std::optional<StandingPlane>& plane);

  double wallThickness () const override { return wall_m_; }

  /** \brief The same: its floor was seen. */
  std::shared_ptr<const WallProfile> withoutFloor () const override { return std::make_shared<DishProfile> (*this); }

  VesselPart partOf (const ProfilePoint& point) const override;

  std::vector<ProfilePoint> depths (double step_m) const override;

  bool holds (const ProfilePoint& point) const override;

  double depthInCavity (const Eigen::Vector2d& position) const override;

  double depthUnder (const Eigen::Vector2d& position) const override;

private:
  /** \brief A place of the inside, upwards from the bottom, and its normal. */
  struct Place
  {
    Eigen::Vector2d position;
    Eigen::Vector2d normal;
  };

  /** \brief Does the border rise more steeply than crockery does? \param[in] rim height */
  bool isGrazing (double rim) const;
  bool findInside (const std::vector<ProfilePoint>& points, double step_m);
  Eigen::Vector2d vertical (const Eigen::Vector2d& profile) const { return {up_ * profile.x (), profile.y ()}; }
  /** \brief Over the inside, or less than zero under it; of an vertical place. */
  double heightOver (const Eigen::Vector2d& position) const;

  double up_ = 1.0;           // sense along the axis, in which heights count up
  std::vector<Place> inside_; // from the axis outwards to the edge
  Eigen::Vector2d outwards_;  // there, along the inside; upwards
  double wall_m_ = 0.0;
  double noise_m_ = 0.0; // how far points may be from a side
  double floor_m_ = 0.0; // heights
  double bottom_m_ = 0.0;
  double foot_m_ = 0.0; // radius of the floor
};

} // namespace pcl::cosection
