// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace pcl::cosection
{

/** \brief A point of a surface of revolution in the half plane that its axis bounds; of a box, in the one across a
 * wall. */
struct ProfilePoint
{
  Eigen::Vector2d position; // height along the axis, distance from it
  Eigen::Vector2d normal;   // component along the axis, away from it
};

/** \brief A plane across the axis on which it stands. */
struct StandingPlane
{
  double height; // along the axis
  double up;     // 1 or -1: the sense of the axis in which the surface is
};

/** \brief What is known of the wall of something hollow, in the half plane of its profile. */
class WallProfile
{
public:
  virtual ~WallProfile () = default;

  /** \brief Across the wall, metres. */
  virtual double wallThickness () const = 0;

  /** \brief The same wall, open at both ends. */
  virtual std::shared_ptr<const WallProfile> withoutFloor () const = 0;

  /** \brief To which part of the surface a point belongs, by its normal; and by its height, to the rim. */
  virtual VesselPart partOf (const ProfilePoint& point) const = 0;

  /** \brief What views see least of. \param[in] step_m between points */
  virtual std::vector<ProfilePoint> depths (double step_m) const = 0;

  /** \brief Is a point on one of the sides of the wall, the rim, the floor or the bottom? Else it is of a handle. */
  virtual bool holds (const ProfilePoint& point) const = 0;

  /** \brief How far a place in the cavity is from the wall and the floor, the less of both; metres, 0 elsewhere.
   * \param[in] position as in ProfilePoint */
  virtual double depthInCavity (const Eigen::Vector2d& position) const = 0;

  /** \brief How far a place under a dish is from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  virtual double depthUnder (const Eigen::Vector2d& /*position*/) const { return 0.0; }
};

} // namespace pcl::cosection
