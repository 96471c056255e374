// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/vessels/wall_profile.h"

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Least cosine between a vertical axis and a plane's normal. */
constexpr double vertical_cosine = 0.97;

/** \brief A surface with the same profile on all sides of an axis: a surface of revolution, or an open box. */
class ProfileSurface
{
public:
  virtual ~ProfileSurface () = default;

  /** \brief A point of the axis, in the middle of the observed heights. */
  const Eigen::Vector3d& center () const { return center_; }

  /** \brief Unit direction of the axis. */
  const Eigen::Vector3d& direction () const { return direction_; }

  /** \brief Whether it is the same about any other axis through its centre. */
  virtual bool isBall () const { return false; }

  /** \brief Whether the profile was seen on many sides at this height and distance. Other points belong to a handle. */
  bool holds (const Eigen::Vector3d& position) const;

  /** \brief Support function of the surface without handles, max n.(p - center ()); metres. */
  double extent (const Eigen::Vector3d& n) const;

  /** \brief Copies, on other sides of the axis, of the points for which holds () is true. */
  std::vector<OrientedPoint> copies (const std::vector<OrientedPoint>& points) const;

  /** \brief The profile of its wall; null if it is no vessel. */
  const WallProfile* vessel () const { return vessel_.get (); }

  /** \brief Make a vessel a tube, open at both ends. A dish stays as it is: its floor was seen. */
  void openFloor ()
  {
    if (vessel_)
      vessel_->openFloor ();
  }

  /** \brief The part of a vessel to which a point belongs; the outer side for other shapes. */
  VesselPart partOf (const OrientedPoint& point) const
  {
    return vessel_ ? vessel_->partOf (profilePointOf (point)) : VesselPart::Outer;
  }

  /** \brief Distance of a place in the cavity of a vessel from the wall (across the axis) or above the floor, the
   * smaller one; metres, 0 elsewhere. */
  double depthInCavity (const Eigen::Vector3d& position) const
  {
    return vessel_ ? vessel_->depthInCavity (profileOf (position)) : 0.0;
  }

  /** \brief Distance of a place under a dish from its wall and foot, metres; 0 elsewhere, and for other vessels. */
  double depthUnder (const Eigen::Vector3d& position) const
  {
    return vessel_ ? vessel_->depthUnder (profileOf (position)) : 0.0;
  }

  /** \brief Points of the parts of a vessel that views see least: lower parts of both sides, floor and bottom.
   * \param[in] step_m between points */
  std::vector<OrientedPoint> depths (double step_m) const;

protected:
  enum class Hollow // what a surface may be
  {
    None,
    Vessel, // both sides of its wall were seen
    Dish,
    Any
  };

  /** \brief A place at some distance from the axis. */
  struct Place
  {
    Eigen::Vector3d offset; // from the axis, across it
    Eigen::Vector3d away;   // unit, across the axis
  };

  /** \brief The turns and reflections about center () that make the copies. */
  virtual std::vector<Eigen::Matrix3d> turns () const = 0;

  /** \brief Distance from the axis of a place \a q in the plane across it; for a box, constant along outlines parallel
   * to the walls. */
  virtual double distanceOf (const Eigen::Vector3d& q) const = 0;

  /** \brief The gradient of distanceOf (). */
  virtual Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const = 0;

  /** \brief Support function of the outline at that distance, along \a n across the axis. */
  virtual double reachOf (const Eigen::Vector3d& n, double distance) const = 0;

  /** \brief Places of the outline at that distance, all around the axis. */
  virtual std::vector<Place> around (double distance, double step_m) const = 0;

  /** \brief Find the part of the profile that was seen on many sides.
   * \param[in] size_m NormalLines::size of the points
   * \param[in] least_sectors around the axis, next to each other, in which points must face sideways */
  bool findProfile (const std::vector<OrientedPoint>& points, double size_m, int least_sectors);
  void findVessel (const std::optional<Eigen::Vector4d>& plane, Hollow hollow);

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitZ ();
  double cell_m_ = 0.0;                 // edge of the cells of the profile
  std::vector<ProfilePoint> profile_;   // of the points that it holds
  std::shared_ptr<WallProfile> vessel_; // null if it is not hollow

private:
  Eigen::Vector2d profileOf (const Eigen::Vector3d& position) const; // height along the axis, distance from it
  ProfilePoint profilePointOf (const OrientedPoint& point) const;

  std::size_t indexOf (const Eigen::Vector2i& cell) const
  {
    return static_cast<std::size_t> (cell.y ()) * cells_.x () + cell.x ();
  }

  Eigen::Vector2i cells_ = Eigen::Vector2i::Zero ();
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero (); // origin of the cells, height and distance
  std::vector<std::uint8_t> held_;                   // by cell
};

/** \brief Fit a surface of revolution to the points of one body.
 * \param[in] plane support plane (n, d) with n.x + d = 0, unit n towards the body: an axis along n is preferred to
 * others that are about as good
 * \param[in] alone its surroundings are unknown: without a plane, the rim of a dish may determine the axis
 * \return null if less than three quarters of the points belong to such a surface, or less than 70 degrees of it were
 * seen. For a plate, which hardly faces sideways, a round outline as seen from above suffices */
std::shared_ptr<ProfileSurface> fitSurfaceOfRevolution (const std::vector<OrientedPoint>& points,
                                                        const std::optional<Eigen::Vector4d>& plane, bool alone);

/** \brief Fit an open box to the points of one body.
 * \param[in] faces normals of its large faces: without a plane, the floor is one of them
 * \param[in] plane support plane (n, d) with n.x + d = 0, unit n towards the body
 * \return null if it is not hollow, or less than three quarters of the points belong to such walls and their floor */
std::shared_ptr<ProfileSurface> fitOpenBox (const std::vector<OrientedPoint>& points,
                                            const std::vector<Eigen::Vector3d>& faces,
                                            const std::optional<Eigen::Vector4d>& plane);

} // namespace pcl::cosection
