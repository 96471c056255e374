// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "half_spaces.h"
#include "profile_surface.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Which shapes with a profile are recognised. */
struct Profiles
{
  bool solid = true;
  bool hollow = true;
};

/** \brief A shape with the same profile on all sides of an axis, if the points of an object show one: a surface of
 * revolution, whatever the direction of its axis, or an open box (a tray or a bin with a rectangular outline and equal
 * walls).
 *
 * The observed profile is copied to all sides: by all turns about the axis, or by reflection in the middle planes of an
 * open box. A handle or a spout, which was seen in less than 50 degrees, is not copied. */
class ProfiledShape
{
public:
  /** \brief Without a support plane.
   * \param[in] points of the object, in one frame
   * \param[in] alone its surroundings are unknown: the rim of a dish may then determine its axis */
  explicit ProfiledShape (const std::vector<OrientedPoint>& points, bool alone = true, const Profiles& profiles = {})
  {
    build (points, std::nullopt, alone, profiles);
  }

  /** \brief On a support plane. If no observed point comes down to it, the object touches it at the axis.
   * \param[in] plane (n, d) with n.x + d = 0, unit n towards the object */
  ProfiledShape (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane, const Profiles& profiles = {})
  {
    build (points, plane, false, profiles);
  }

  /** \brief Whether there is a profile. All that follows is about it. */
  explicit operator bool () const { return profile_ != nullptr; }

  /** \brief The convex hull of a vessel: of its points and their copies, as the intersection of half-spaces
   * { x : n_k.x <= s_k } of fixed directions n_k and of the normals of large faces; s_k is the largest n_k.p over all
   * points p, except for 0.2 % of outliers, and their copies. */
  const HalfSpaces& region () const { return region_; }

  /** \brief Copies of points on all sides, including those of cavities. For a vessel, also points of the parts that
   * views see least, in steps of \a step_m: the lower parts of both sides, floor and bottom. */
  std::vector<OrientedPoint> hiddenSide (const std::vector<OrientedPoint>& points, double step_m) const;

  /** \brief A point of the axis. */
  Eigen::Vector3d center () const { return profile_ ? profile_->center () : Eigen::Vector3d::Zero (); }

  /** \brief Direction of the axis; nothing for a ball, which has many. */
  std::optional<Eigen::Vector3d> axisDirection () const
  {
    return profile_ && !profile_->isBall () ? std::optional<Eigen::Vector3d> (profile_->direction ()) : std::nullopt;
  }

  /** \brief Wall thickness of a vessel (a cup, a bowl or an open box), metres; 0 for other shapes. */
  double wallThickness () const
  {
    return profile_ && profile_->vessel () ? profile_->vessel ()->wallThickness () : 0.0;
  }

  /** \brief Make a vessel, and that of all copies of this, a tube, open at both ends. */
  void openFloor () { profile_->openFloor (); }

  /** \brief Whether a place belongs to the shape with a profile, and not to a handle. */
  bool holds (const Eigen::Vector3d& position) const { return profile_ && profile_->holds (position); }

  /** \brief Distance of a place in the cavity of a vessel from the wall (across the axis) or above the floor, the
   * smaller one; metres, 0 elsewhere. */
  double depthInCavity (const Eigen::Vector3d& position) const
  {
    return profile_ ? profile_->depthInCavity (position) : 0.0;
  }

  /** \brief Distance of a place under a dish from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  double depthUnder (const Eigen::Vector3d& position) const { return profile_ ? profile_->depthUnder (position) : 0.0; }

  /** \brief The part of a vessel's surface to which a point, or a copy, belongs; the outer side for other shapes. */
  VesselPart partOf (const OrientedPoint& point) const
  {
    return profile_ ? profile_->partOf (point) : VesselPart::Outer;
  }

  /** \brief Whether most of the points belong to a few flat faces; with or without a profile. */
  bool isFaceted () const { return faceted_; }

private:
  ProfiledShape () = default;
  void build (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone,
              const Profiles& profiles);

  bool faceted_ = false;
  std::shared_ptr<ProfileSurface> profile_; // null without a profile
  HalfSpaces region_;
};

} // namespace pcl::cosection
