// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection
{

class PrismWalls;
class ProfileSurface;

/** \brief Parts of the surface of what is hollow: a cup, a bowl or a box without its lid. */
enum class VesselPart
{
  Outer, ///< side of the wall
  Inner, ///< side of the wall, and the floor
  Rim,
  Bottom
};

/** \brief Points of an vertical wall, one over the other. */
using WallColumn = std::vector<OrientedPoint>;

/** \brief How far an object would reach if what is hidden of it looked like what was seen of it.
 *
 * Boxes, cans, bottles, bowls, vehicles: most things look from behind about as from the front. So what was
 * observed, S, is completed by a copy that is turned by half a revolution about an axis along the normal of the
 * plane on which the object rests, or, without such a plane, inverted through a point. The axis or point c is the
 * middle between the two observed points that are farthest apart (seen along the axis): of what is seen of a box,
 * these are opposite corners. If S is a surface of revolution, the axis is its own, whatever its direction, and the
 * copies are those by all turns, but of a handle or a spout: what was seen in less than 50 degrees in a row stays where
 * it is. If S is an open box, a tray or a bin with a rectangle as its outline and walls that are alike, they are those
 * mirrored at its middle planes.
 *
 * The plausible region is the convex hull of S and its copy, as the intersection of half spaces { x : n_k.x <= s_k }
 * of fixed directions n_k and of those in which large parts of the surface face; s_k is the largest n_k.p of all
 * points p, but for 0.2 %, and of their copies. */
class SymmetricExtent
{
public:
  /** \brief Inverted through a point. \param[in] points the object's, of one frame
   * \param[in] alone nothing around it is known: of dishes, the rim may then tell which way is up */
  explicit SymmetricExtent (const std::vector<OrientedPoint>& points, bool alone = true);

  /** \brief Turned about an axis along the normal of what the object stands on. If nothing that was seen comes down to
   * it, the object touches it where the axis does. \param[in] plane (n, d) with n.x + d = 0, unit n towards the object
   */
  SymmetricExtent (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane);

  /** \brief max_k (n_k.x - s_k): at most the distance to the plausible region, negative inside; metres. */
  double beyond (const Eigen::Vector3d& x) const;

  /** \brief The same for \a first + i * \a step, i = 0 ... \a count - 1. \param[out] values metres */
  void beyond (const Eigen::Vector3d& first, const Eigen::Vector3d& step, int count, float* values) const;

  /** \brief The same in a box, of as few half spaces as are needed there. */
  SymmetricExtent within (const Eigen::AlignedBox3d& box) const;

  /** \brief The copies, by half a revolution or through the point, of those of \a points that come to lie beyond the
   * plausible region or less than \a reach (metres) inside it: where the hidden side is to be expected. Of what has a
   * profile, the copies to all sides, those of cavities too, and what views see least of a vessel, in steps of \a
   * reach: the depths of both its sides, its floor and its bottom; and of what is no vessel flat faces at the ends of
   * straight walls, if no plane is known on which they end. */
  std::vector<OrientedPoint> hiddenSide (const std::vector<OrientedPoint>& points, double reach) const;

  /** \brief A point of the axis, or the point of inversion. */
  const Eigen::Vector3d& center () const { return center_; }

  /** \brief Is the hidden side to be expected where hiddenSide () has it? Yes for what stands on a plane, is round or
   * is bounded by faces at right angles; no for anything else, inverted through a point. */
  bool copiesAreAlike () const { return copies_alike_; }

  /** \brief Is it the same on all sides of an axis: a surface of revolution, or an open box? */
  bool hasProfile () const { return profile_ != nullptr; }

  /** \brief Direction of the axis about which it is round; nothing for a ball, which has many, and for what is not
   * round. */
  std::optional<Eigen::Vector3d> axisDirection () const;

  /** \brief Do a few flat faces make up most of what was seen? */
  bool isFaceted () const { return faceted_; }

  /** \brief Of a vessel, a cup, a bowl or an open box: how thick its wall is, metres; 0 of anything else. */
  double wallThickness () const;

  /** \brief The same; a vessel open at both ends, which is a tube. */
  SymmetricExtent withoutFloor () const;

  /** \brief Of what stands on a plane and is bounded by vertical walls, and tops that are level: all walls of its
   * convex outline, seen or not; of anything else none. \param[in] step_m between points \param[in] of_copies of the
   * outline of copies, too; else its top must have been seen */
  std::vector<WallColumn> verticalWalls (double step_m, bool of_copies) const;

  /** \brief Of such a thing, walls below the edges of the tops that were seen, which need not be convex; each down to
   * the plane or to a lower top. */
  std::vector<WallColumn> wallsBelowEdges (double step_m) const;

  /** \brief The same of an object of which more is expected than was seen: the hidden side is that of these \a points,
   * too. */
  SymmetricExtent continuedBy (const std::vector<OrientedPoint>& points) const;

  /** \brief The same; its hidden side are these walls, rather than copies. \param[in] below_top only what is below the
   * top that was seen is inside of them, if all of the top is level */
  SymmetricExtent boundedBy (const std::vector<OrientedPoint>& walls, bool below_top) const;

  /** \brief Is it bounded by vertical walls? */
  bool isPrism () const { return !has_copies_; }

  /** \brief Component along up () of the top, if nothing but what is below that is inside of its walls. */
  const std::optional<double>& top () const { return top_; }

  /** \brief Direction of the normal of the plane on which it stands; zero if there is none. */
  const Eigen::Vector3d& up () const { return up_; }

  /** \brief What is expected beside copies of what was seen. */
  const std::vector<OrientedPoint>& continuation () const { return continuation_; }

  /** \brief Does a place belong to what has a profile, not to a handle of it? */
  bool holds (const Eigen::Vector3d& position) const;

  /** \brief How far a place in the cavity of a vessel is from the wall, across the axis, and over the floor, the less
   * of both; metres, 0 elsewhere. */
  double depthInCavity (const Eigen::Vector3d& position) const;

  /** \brief How far a place under a dish is from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  double depthUnder (const Eigen::Vector3d& position) const;

  /** \brief On which part of a vessel's surface a point, or a copy of one, is; the outer side of what is none. */
  VesselPart partOf (const OrientedPoint& point) const;

private:
  SymmetricExtent () = default;
  /** \brief A copy turned by half a revolution, or inverted. */
  OrientedPoint turned (OrientedPoint point) const;
  void expect (const std::vector<OrientedPoint>& points);
  void build (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone);

  bool standing_ = false; // on a plane
  bool copies_alike_ = false;
  bool faceted_ = false;
  std::shared_ptr<const ProfileSurface> profile_; // null: it has none
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity ();
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  std::vector<std::pair<Eigen::Vector3d, double>> half_spaces_; // n_k, s_k
  std::shared_ptr<const PrismWalls> walls_;                     // null: it has none that are vertical
  std::shared_ptr<const PrismWalls> walls_with_copies_;
  bool has_copies_ = true;
  std::optional<double> top_;
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero ();
  std::vector<OrientedPoint> continuation_; // points that are expected beside those that were seen, with their copies
};

} // namespace pcl::cosection
