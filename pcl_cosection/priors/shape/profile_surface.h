// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/priors/vessels/wall_profile.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief Cosine between an axis and a plane's normal, from which on it is vertical. */
constexpr double vertical = 0.97;

/** \brief A surface that has the same profile on all sides of an axis: a surface of revolution, or a box. */
class ProfileSurface
{
public:
  virtual ~ProfileSurface () = default;

  /** \brief A point of the axis, in the middle of what was seen along it. */
  const Eigen::Vector3d& center () const { return center_; }

  /** \brief Unit direction of the axis. */
  const Eigen::Vector3d& direction () const { return direction_; }

  /** \brief Is it the same about any other axis through its center? */
  virtual bool isBall () const { return false; }

  /** \brief Does a point lie where the profile was seen on many sides? Else it is of a handle. */
  bool holds (const Eigen::Vector3d& position) const;

  /** \brief Farthest along \a n of the surface, but for its handles, from the point \a center () on; metres. */
  double extent (const Eigen::Vector3d& n) const;

  /** \brief Copies of those of the points that the surface holds, on other sides of the axis. */
  std::vector<OrientedPoint> copies (const std::vector<OrientedPoint>& points) const;

  /** \brief Copies of any points on other sides of the axis. */
  virtual std::vector<OrientedPoint> onOtherSides (const std::vector<OrientedPoint>& points) const = 0;

  /** \brief Flat faces at those ends of the axis to which a straight wall leads: the bottom of a can that stood on a
   * table. */
  virtual std::vector<OrientedPoint> flatEnds () const { return {}; }

  /** \brief What is known of its wall, if it is a vessel. */
  const WallProfile* vessel () const { return vessel_.get (); }

  /** \brief The same; a vessel open at both ends. */
  virtual std::shared_ptr<const ProfileSurface> withoutFloor () const = 0;

  /** \brief To which part of a vessel a point belongs; outer side if it is none. */
  VesselPart partOf (const OrientedPoint& point) const;

  /** \brief How far a place in the cavity of a vessel is from the wall, across the axis, and over the floor, the less
   * of both; metres, 0 elsewhere. */
  double depthInCavity (const Eigen::Vector3d& position) const;

  /** \brief How far a place under a dish is from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  double depthUnder (const Eigen::Vector3d& position) const;

  /** \brief The depths of a vessel: lower parts of both sides, floor and bottom. \param[in] step_m between points */
  std::vector<OrientedPoint> depths (double step_m) const;

protected:
  enum class Hollow // what a surface may be
  {
    None,
    Vessel, // with a wall of which both sides were seen
    Dish,
    Any
  };

  /** \brief A place at some distance from the axis. */
  struct Place
  {
    Eigen::Vector3d offset; // from the axis, across it
    Eigen::Vector3d away;   // unit, across the axis
  };

  /** \brief Distance from the axis of a place \a q of the plane across it; of a box's walls, the same for all. */
  virtual double distanceOf (const Eigen::Vector3d& q) const = 0;

  /** \brief Its gradient. */
  virtual Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const = 0;

  /** \brief Farthest along \a n, across the axis, of all that is so far away. */
  virtual double reachOf (const Eigen::Vector3d& n, double distance) const = 0;

  /** \brief All around the axis. */
  virtual std::vector<Place> around (double distance, double step_m) const = 0;

  Eigen::Vector2d profileOf (const Eigen::Vector3d& position) const;  // height along the axis, distance from it
  Eigen::Vector2d profileNormalOf (const OrientedPoint& point) const; // component along the axis, away from it
  /** \brief Where does the profile of some points hold? \param[in] size_m theirs \param[in] least_sectors around the
   * axis in a row, in which they face sideways */
  bool findProfile (const std::vector<OrientedPoint>& points, double size_m, int least_sectors);
  void findVessel (const std::optional<Eigen::Vector4d>& plane, Hollow hollow);
  /** \brief Is a point of the surface, and not of a handle? */
  bool isOfProfile (const OrientedPoint& point) const;

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitZ ();
  double cell_m_ = 0.0;                       // edge of the cells of the profile
  std::vector<ProfilePoint> profile_;         // of the points that it holds
  std::shared_ptr<const WallProfile> vessel_; // none if it is not hollow

private:
  Eigen::Vector2i cellOf (const Eigen::Vector2d& profile) const;
  std::size_t indexOf (const Eigen::Vector2i& cell) const;

  Eigen::Vector2i cells_ = Eigen::Vector2i::Zero ();
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero (); // of all cells, height and distance
  std::vector<std::uint8_t> held_;                   // by cell
};

} // namespace pcl::cosection
