// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Parts of the surface of a hollow thing: a cup, a bowl or an open box. */
enum class VesselPart
{
  Outer, ///< side of the wall
  Inner, ///< side of the wall, and the floor
  Rim,
  Bottom
};

/** \brief A point in the half plane of the profile, which is bounded by the axis; for a box, the half plane across the
 * nearest wall. */
struct ProfilePoint
{
  Eigen::Vector2d position; // height along the axis, distance from the axis
  Eigen::Vector2d normal;   // components along the axis and away from it
};

/** \brief The support plane, across the axis. */
struct StandingPlane
{
  double height; // along the axis
  double up;     // 1 or -1: the sense of the axis towards the surface
};

/** \brief The wall of a vessel, in the half plane of its profile. */
class WallProfile
{
public:
  virtual ~WallProfile () = default;

  /** \brief Thickness of the wall, metres. */
  double wallThickness () const { return wall_m_; }

  /** \brief Make this wall that of a tube, open at both ends; a dish, whose floor was seen, stays as it is. */
  virtual void openFloor () {}

  /** \brief The part of the surface to which a point belongs, by its normal; the rim also by its height. */
  virtual VesselPart partOf (const ProfilePoint& point) const = 0;

  /** \brief Points of the parts that views see least. \param[in] step_m between points */
  virtual std::vector<ProfilePoint> depths (double step_m) const = 0;

  /** \brief Whether a point is on a side of the wall, the rim, the floor or the bottom, and not on a handle. */
  virtual bool holds (const ProfilePoint& point) const = 0;

  /** \brief Distance of a place in the cavity from the wall or above the floor, the smaller one; metres, 0 elsewhere.
   * \param[in] position as in ProfilePoint */
  virtual double depthInCavity (const Eigen::Vector2d& position) const = 0;

  /** \brief Distance of a place under a dish from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  virtual double depthUnder (const Eigen::Vector2d& /*position*/) const { return 0.0; }

protected:
  double wall_m_ = 0.0; // from side to side
};

/** \brief Fit the profile of a vessel whose wall was seen from both sides.
 * \param[in] points of the whole surface
 * \param[in] cell_m height of the bands in which the sides are compared
 * \return null if it is not hollow, its walls differ in thickness, or both its ends are open */
std::shared_ptr<WallProfile> fitVessel (const std::vector<ProfilePoint>& points, double cell_m,
                                        const std::optional<StandingPlane>& plane);

/** \brief Fit the profile of a plate or bowl that showed only its inside, and perhaps the edge.
 * \param[in] points of the whole surface
 * \param[in] cell_m twice the length of the parts into which the profile is divided
 * \return null if there is no rising border around a horizontal floor, or if more than the inside and the edge was
 * seen */
std::shared_ptr<WallProfile> fitDish (const std::vector<ProfilePoint>& points, double cell_m,
                                      const std::optional<StandingPlane>& plane);

} // namespace pcl::cosection
