// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "normal_axis.h"
#include "wall_profile.h"

#include <pcl/cosection/surface/oriented_point.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Cosine between an axis and a plane's normal, from which on it is upright. */
constexpr double upright = 0.97;

/** \brief What is round about some axis: a bottle, a can, a bowl, a ball, a mug but for its handle. */
class SurfaceOfRevolution
{
public:
  /** \brief Of the points of one body. \param[in] plane what it stands on, (n, d) with n.x + d = 0, unit n towards it: an axis along n is
   * preferred to others that are about as good
   * \param[in] alone nothing around it is known: without a plane, a dish may be told by its rim
   * \return nothing if less than three quarters of the points belong to such a surface, or less than 70 degrees were seen of it; but a plate,
   * which hardly faces sideways, may be round as seen from above */
  static std::optional<SurfaceOfRevolution>
  fit (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone = true);

  /** \brief A point of the axis, in the middle of what was seen along it. */
  const Eigen::Vector3d&
  center () const
  {
    return center_;
  }

  /** \brief Unit direction of the axis. */
  const Eigen::Vector3d&
  direction () const
  {
    return direction_;
  }

  /** \brief Round about any axis. */
  bool
  isBall () const
  {
    return is_ball_;
  }

  /** \brief Does a point lie on what is round, in any direction from the axis? */
  bool
  holds (const Eigen::Vector3d& position) const;

  /** \brief Farthest along \a n of all that is round, from the point \a center () on; metres. */
  double
  extent (const Eigen::Vector3d& n) const;

  /** \brief Copies of those of the points that lie on what is round, turned about the axis to all sides. */
  std::vector<OrientedPoint>
  turned (const std::vector<OrientedPoint>& points) const;

  /** \brief Flat faces at those ends of the axis to which a straight wall leads: the bottom of a can that stood on a table. */
  std::vector<OrientedPoint>
  flatEnds () const;

  /** \brief What is known of its wall, if it is a vessel. */
  const WallProfile*
  vessel () const
  {
    return vessel_.get ();
  }

  /** \brief The same; a vessel open at both ends. */
  SurfaceOfRevolution
  withoutFloor () const
  {
    SurfaceOfRevolution tube = *this;
    if (vessel_)
      tube.vessel_ = vessel_->withoutFloor ();
    return tube;
  }

  /** \brief To which part of a vessel a point belongs; outer side if it is none. */
  VesselPart
  partOf (const OrientedPoint& point) const;

  /** \brief How far a place in the cavity of a vessel is from the wall, across the axis, and over the floor, the less of both; metres, 0 elsewhere. */
  double
  depthInCavity (const Eigen::Vector3d& position) const;

  /** \brief How far a place under a dish is from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  double
  depthUnder (const Eigen::Vector3d& position) const;

  /** \brief The depths of a vessel: lower parts of both sides, floor and bottom. \param[in] step_m between points */
  std::vector<OrientedPoint>
  depths (double step_m) const;

private:
  enum class Hollow // what a surface may be
  {
    None,
    Vessel, // with a wall of which both sides were seen
    Dish,
    Any
  };

  SurfaceOfRevolution () = default;
  /** \brief About a known axis. \param[in] least_sectors around it in a row, in which points face sideways \return nothing if too few belong to it */
  static std::optional<SurfaceOfRevolution>
  about (const Axis& axis, const NormalLines& normals, const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane,
         int least_sectors, Hollow hollow);
  bool
  findProfile (const std::vector<OrientedPoint>& points, double size, int least_sectors);
  /** \brief Of all that is round, metres. */
  double
  radius () const;
  Eigen::Vector2i
  cellOf (const Eigen::Vector2d& profile) const;
  std::size_t
  indexOf (const Eigen::Vector2i& cell) const;
  Eigen::Vector2d
  profileOf (const Eigen::Vector3d& position) const; // height along the axis, distance from it
  Eigen::Vector2d
  profileNormalOf (const OrientedPoint& point) const; // component along the axis, away from it

  Eigen::Vector3d center_;
  Eigen::Vector3d direction_;
  bool is_ball_ = false;
  double cell_m_ = 0.0; // edge of the cells of the profile
  Eigen::Vector2i cells_;
  Eigen::Vector2d first_; // of all cells, height and distance
  std::vector<std::uint8_t> round_; // by cell
  std::vector<ProfilePoint> profile_; // of the points that are round
  std::shared_ptr<const WallProfile> vessel_; // none if it is not hollow
};

} // namespace cosection
} // namespace pcl
