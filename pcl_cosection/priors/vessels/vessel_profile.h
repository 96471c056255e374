// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "wall_profile.h"

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief The profile of a vessel: a wall of even thickness between an outer and an inner side, round about an axis and
 * open at one of its ends.
 *
 * Of what is deep inside a vessel views see little, and of its bottom nothing. What is hidden is taken to go on as it
 * was seen: the wall is as thick as where both its sides were seen, down to the floor, which is level; and that is
 * where it was seen, or as far above the bottom as the wall is thick. */
class VesselProfile : public WallProfile
{
public:
  /** \param[in] points of the whole surface \param[in] cell_m height of the bands in which the sides are compared
   * \return nothing if it is not hollow, its walls differ in thickness, or both its ends are open */
  static std::shared_ptr<const VesselProfile> find (const std::vector<ProfilePoint>& points, double cell_m,
                                                    const std::optional<StandingPlane>& plane);

  double wallThickness () const override { return wall_m_; }

  std::shared_ptr<const WallProfile> withoutFloor () const override;

  VesselPart partOf (const ProfilePoint& point) const override;

  /** \brief The lower parts of both sides, floor and bottom. */
  std::vector<ProfilePoint> depths (double step_m) const override;

  bool holds (const ProfilePoint& point) const override;

  double depthInCavity (const Eigen::Vector2d& position) const override;

private:
  struct Band // of heights
  {
    double height;
    double outer; // radius
    double wall;  // across the axis
  };

  bool findWall (const std::vector<ProfilePoint>& points, double cell_m);
  /** \brief Once it is known how thick the wall is. */
  void findBands (const std::vector<ProfilePoint>& points, double band_m);
  bool findBottom (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane);
  /** \brief Between the bands that are known, and beyond. */
  Band bandAt (double height) const;
  double outerAt (double height) const;
  double innerAt (double height) const;

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

} // namespace pcl::cosection
