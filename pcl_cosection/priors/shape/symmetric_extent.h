// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "flat_faces.h"
#include "profile_surface.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Which shapes with a profile are recognised. */
struct Profiles
{
  bool solid = true;
  bool hollow = true;
};

/** \brief The symmetry prior: the extent of an object whose hidden side resembles its visible side.
 *
 * Boxes, cans, bottles, bowls, vehicles: most things look from behind about as from the front. So the observed surface
 * S is completed by copies:
 *
 * - by a half turn about an axis along the normal of the support plane. Without a plane, S is inverted in a point. The
 *   axis or point c is the middle of the two observed points that are farthest apart (seen along the axis): for a box,
 *   these are opposite corners.
 * - If S is a surface of revolution, by all turns about its own axis, whatever its direction. A handle or a spout,
 *   which was seen in less than 50 degrees, is not copied.
 * - If S is an open box (a tray or a bin with a rectangular outline and equal walls), by reflection in its two middle
 *   planes.
 *
 * The plausible region is the convex hull of S and its copies, as the intersection of half-spaces { x : n_k.x <= s_k }
 * of fixed directions n_k and of the normals of large faces; s_k is the largest n_k.p over all points p, except for
 * 0.2 % of outliers, and their copies. */
class SymmetricExtent
{
public:
  /** \brief Without a support plane: copies by inversion in a point, unless there is a profile.
   * \param[in] points of the object, in one frame
   * \param[in] alone its surroundings are unknown: the rim of a dish may then determine its axis */
  explicit SymmetricExtent (const std::vector<OrientedPoint>& points, bool alone = true, const Profiles& profiles = {})
  {
    build (points, std::nullopt, alone, profiles);
  }

  /** \brief With a support plane: copies by a half turn about its normal, unless there is a profile. If no observed
   * point comes down to the plane, the object touches it at the axis.
   * \param[in] plane (n, d) with n.x + d = 0, unit n towards the object */
  SymmetricExtent (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                   const Profiles& profiles = {})
  {
    build (points, plane, false, profiles);
  }

  /** \brief Signed distance to the half-spaces, max_k (n_k.x - s_k): at most the distance to the plausible region,
   * negative inside; metres. */
  double beyond (const Eigen::Vector3d& x) const;

  /** \brief Signed distances of the places \a first + i * \a step, i = 0 ... \a count - 1.
   * \param[out] values metres */
  void beyond (const Eigen::Vector3d& first, const Eigen::Vector3d& step, int count, float* values) const;

  /** \brief The part of this for beyond () at places in a box: as few half-spaces as are needed there. */
  SymmetricExtent within (const Eigen::AlignedBox3d& box) const;

  /** \brief Points of the expected hidden side.
   *
   * - In general, the copies of \a points that lie less than \a reach (metres) inside the plausible region.
   * - With a profile, the copies on all sides, including those of cavities.
   * - For a vessel, also points of the parts that views see least, in steps of \a reach: the lower parts of both sides,
   *   floor and bottom.
   * - For other shapes with a profile, also flat faces at the ends of straight walls, if there is no support plane. */
  std::vector<OrientedPoint> hiddenSide (const std::vector<OrientedPoint>& points, double reach) const;

  /** \brief A point of the axis, or the point of inversion. */
  const Eigen::Vector3d& center () const { return center_; }

  /** \brief Whether hiddenSide () is reliable: true for things that stand on a plane, have a profile or are bounded by
   * faces at right angles; false for anything else inverted in a point. */
  bool copiesAreAlike () const { return copies_alike_; }

  /** \brief Whether it has the same profile on all sides of an axis: a surface of revolution, or an open box. */
  bool hasProfile () const { return profile_ != nullptr; }

  /** \brief Direction of the axis of revolution; nothing for a ball, which has many, and for other shapes. */
  std::optional<Eigen::Vector3d> axisDirection () const
  {
    return profile_ && !profile_->isBall () ? std::optional<Eigen::Vector3d> (profile_->direction ()) : std::nullopt;
  }

  /** \brief Whether most of the points belong to a few flat faces. */
  bool isFaceted () const { return faceted_; }

  /** \brief Wall thickness of a vessel (a cup, a bowl or an open box), metres; 0 for other shapes. */
  double wallThickness () const
  {
    return profile_ && profile_->vessel () ? profile_->vessel ()->wallThickness () : 0.0;
  }

  /** \brief This extent with the vessel as a tube, open at both ends. */
  SymmetricExtent withoutFloor () const;

  /** \brief All walls of the convex outline, seen or not, of a thing on a plane with vertical walls and horizontal
   * tops; empty for other shapes.
   * \param[in] step_m between points
   * \param[in] of_copies use the outline of points and copies; otherwise of points, whose top must have been seen */
  std::vector<WallColumn> verticalWalls (double step_m, bool of_copies) const
  {
    const std::shared_ptr<const PrismWalls>& walls = of_copies ? walls_with_copies_ : walls_;
    return walls ? walls->columns (step_m) : std::vector<WallColumn> ();
  }

  /** \brief Walls of such a thing below the edges of its observed tops, which need not be convex; each down to the
   * plane or to a lower top. */
  std::vector<WallColumn> wallsBelowEdges (double step_m) const
  {
    return walls_ ? walls_->belowEdges (step_m) : std::vector<WallColumn> ();
  }

  /** \brief The extent of an object for which further points are expected: hiddenSide () includes these \a points and
   * their copies. */
  SymmetricExtent continuedBy (const std::vector<OrientedPoint>& points) const;

  /** \brief This extent with the given walls as its hidden side, instead of copies.
   * \param[in] below_top a horizontal observed top covers the whole inside of the walls */
  SymmetricExtent boundedBy (const std::vector<OrientedPoint>& walls, bool below_top) const;

  /** \brief Whether vertical walls are its hidden side (boundedBy ()). */
  bool isPrism () const { return !has_copies_; }

  /** \brief Component along up () of the horizontal top that covers the inside of its walls, if there is one. */
  const std::optional<double>& top () const { return top_; }

  /** \brief Unit normal of the support plane; zero without a plane. */
  const Eigen::Vector3d& up () const { return up_; }

  /** \brief Points that are expected in addition to copies of the observed ones. */
  const std::vector<OrientedPoint>& continuation () const { return continuation_; }

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

private:
  SymmetricExtent () = default;
  std::vector<OrientedPoint> copiesOf (const std::vector<OrientedPoint>& points) const;
  void expect (const std::vector<OrientedPoint>& points);
  void build (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone,
              const Profiles& profiles);

  bool standing_ = false; // on a plane
  bool copies_alike_ = false;
  bool faceted_ = false;
  std::shared_ptr<const ProfileSurface> profile_; // null without a profile
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity ();
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  std::vector<std::pair<Eigen::Vector3d, double>> half_spaces_; // n_k, s_k
  std::shared_ptr<const PrismWalls> walls_;                     // null without vertical walls
  std::shared_ptr<const PrismWalls> walls_with_copies_;
  bool has_copies_ = true;
  std::optional<double> top_;
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero ();
  std::vector<OrientedPoint> continuation_; // points that are expected in addition to the observed ones, with copies
};

} // namespace pcl::cosection
