// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "wall_profile.h"

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The profile of a vessel: a wall of even thickness between an outer and an inner side, round about an axis and
 * open at one end.
 *
 * Views see little of the deep inside of a vessel and nothing of its bottom. The hidden wall is as thick as where both
 * sides were seen, down to the horizontal floor. An unseen floor is as far above the bottom as the wall is thick. */
class VesselProfile : public WallProfile
{
public:
  /** \brief Fit to profile points.
   * \param[in] points of the whole surface
   * \param[in] cell_m height of the bands in which the sides are compared
   * \return nothing if it is not hollow, its walls differ in thickness, or both its ends are open */
  static std::shared_ptr<const VesselProfile> find (const std::vector<ProfilePoint>& points, double cell_m,
                                                    const std::optional<StandingPlane>& plane);

  double wallThickness () const override { return wall_m_; }

  std::shared_ptr<const WallProfile> withoutFloor () const override;

  VesselPart partOf (const ProfilePoint& point) const override;

  /** \brief Points of the lower parts of both sides, floor and bottom. */
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
  /** \brief Find the bands, when wall_m_ is known. */
  void findBands (const std::vector<ProfilePoint>& points, double band_m);
  bool findBottom (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane);
  /** \brief Interpolation and extrapolation of the bands. */
  Band bandAt (double height) const;
  double outerAt (double height) const;
  double innerAt (double height) const;

  double opening_ = 1.0;    // 1 or -1: the sense of the axis towards the opening, which is upwards
  std::vector<Band> bands_; // upwards; bands in which at least one side was seen
  double noise_m_ = 0.0;    // largest distance of points from a side, and tolerance of the wall's thickness
  double rim_band_m_ = 0.0; // points of the rim lie at most so far below its height
  double wall_m_ = 0.0;     // from side to side
  double rim_m_ = 0.0;      // heights
  double bottom_m_ = 0.0;
  double floor_m_ = 0.0;
  bool has_floor_ = true;
  double lowest_outer_m_ = 0.0; // lowest observed heights
  double lowest_inner_m_ = 0.0;
};

} // namespace pcl::cosection
