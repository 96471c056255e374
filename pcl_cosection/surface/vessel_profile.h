// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/symmetric_extent.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief A point of a surface of revolution in the half plane that its axis bounds. */
struct ProfilePoint
{
  Eigen::Vector2d position; // height along the axis, distance from it
  Eigen::Vector2d normal;   // component along the axis, away from it
};

/** \brief A plane across the axis on which a surface of revolution stands. */
struct StandingPlane
{
  double height; // along the axis
  double up;     // 1 or -1: the sense of the axis in which the surface is
};

/** \brief The profile of a vessel: a wall of even thickness between an outer and an inner side, round about an axis and open at one of its ends.
 *
 * Of what is deep inside a vessel views see little, and of its bottom nothing. What is hidden is taken to go on as it was seen: the wall
 * is as thick as where both its sides were seen, down to the floor, which is level; and that is where it was seen, or as far above the bottom
 * as the wall is thick. Of a dish, of which only the inside was seen, the wall is as thick as the floor is high above what it stands on. */
class VesselProfile
{
public:
  /** \param[in] points of the whole surface \param[in] cell_m height of the bands in which the sides are compared
   * \return nothing if it is not hollow, its walls differ in thickness, or both its ends are open */
  static std::optional<VesselProfile>
  find (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane);

  /** \brief Across the wall, metres. */
  double
  wallThickness () const
  {
    return wall_m_;
  }

  /** \brief The same wall, open at both ends. */
  VesselProfile
  withoutFloor () const
  {
    VesselProfile tube = *this;
    tube.has_floor_ = false;
    tube.floor_m_ = bottom_m_;
    return tube;
  }

  /** \brief To which part of the surface a point belongs, by its normal; and by its height, to the rim. */
  VesselPart
  partOf (const ProfilePoint& point) const;

  /** \brief What views see least of: the lower parts of both sides, floor and bottom. \param[in] step_m between points */
  std::vector<ProfilePoint>
  depths (double step_m) const;

  /** \brief Is a point on one of the sides of the wall, the rim, the floor or the bottom? Else it is of a handle. */
  bool
  holds (const ProfilePoint& point) const;

  /** \brief How far a place in the cavity is from the wall, across the axis, and over the floor, the less of both; metres, 0 elsewhere. \param[in] position as in ProfilePoint */
  double
  depthInCavity (const Eigen::Vector2d& position) const;

private:
  struct Band // of heights
  {
    double height;
    double outer; // radius
    double wall;  // across the axis
  };

  VesselProfile () = default;
  bool
  findWall (const std::vector<ProfilePoint>& points, double cell_m);
  /** \brief Once it is known how thick the wall is. */
  void
  findBands (const std::vector<ProfilePoint>& points, double band_m);
  bool
  findBottom (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane);
  /** \brief Wall and bottom of what stands on a plane and shows nothing but its inside, down to its floor. */
  bool
  findDish (const std::vector<ProfilePoint>& points, double cell_m, const StandingPlane& plane);
  double
  outerAt (double height) const;
  double
  innerAt (double height) const;

  double opening_ = 1.0;    // sense along the axis, in which heights count up
  std::vector<Band> bands_; // upwards, where one of the sides at least was seen
  double noise_m_ = 0.0;    // how far points may be from a side, and how much walls may differ
  double rim_band_m_ = 0.0; // how far below its height the rim may be
  double wall_m_ = 0.0;     // from side to side
  double rim_m_ = 0.0;      // heights
  double bottom_m_ = 0.0;
  double floor_m_ = 0.0;
  bool has_floor_ = true;
  double lowest_outer_m_ = 0.0; // of what was seen
  double lowest_inner_m_ = 0.0;
};

} // namespace cosection
} // namespace pcl
