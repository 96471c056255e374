// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_of_revolution.h"

#include "axis_refinement.h"
#include "ball_fit.h"
#include "footprint_axis.h"
#include "normal_axis.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 50;
constexpr double round_share = 0.75;    // of all points
constexpr double sunk = 0.1;            // of the radius: largest depth of a ball in its support plane
constexpr int seen_sectors = 8;         // next to each other: if fewer were seen, the thing may have any shape
constexpr double straight_length = 0.5; // of the radius: a straight wall of this length ends in a flat face
constexpr double straight_sine = 0.2;   // between the wall and the axis
constexpr double straight_share = 0.8;  // of the wall's points
constexpr double outer_wall = 0.9;      // of the radius
constexpr int disc_rings = 24;
constexpr double slender_wall = 0.2; // of the radius
constexpr double thick_wall = 0.3;
constexpr double better = 1.02; // an axis by the rim must hold so many times the points of another axis
constexpr int turns = 12;       // all around

} // namespace

std::optional<SurfaceOfRevolution>
SurfaceOfRevolution::fit (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane,
                          bool alone)
{
  if (points.size () < least_points)
    return std::nullopt;
  const NormalLines normals = normalLinesOf (points);
  if (normals.lines.empty ())
    return std::nullopt;
  if (const std::optional<Ball> ball = findBall (normals.lines))
  {
    const double radius = normals.size * ball->radius;
    const Eigen::Vector3d center = normals.origin + normals.size * ball->center;
    if (!plane || plane->head<3> ().dot (center) + (*plane)[3] > (1.0 - sunk) * radius)
    {
      std::optional<SurfaceOfRevolution> surface = about (axisOf (*ball, normals.lines), normals, points, plane,
                                                          seen_sectors, Hollow::None);
      if (surface)
        surface->is_ball_ = true;
      return surface;
    }
  }
  const auto withAxisAlong = [&] (const std::optional<Eigen::Vector3d>& direction,
                                  Hollow hollow) -> std::optional<SurfaceOfRevolution> {
    const std::optional<Axis> axis = findAxis (normals.lines, direction);
    if (!axis)
      return std::nullopt;
    std::vector<NormalLine> round;
    std::copy_if (normals.lines.begin (), normals.lines.end (), std::back_inserter (round),
                  [&] (const NormalLine& line) { return meets (*axis, line); });
    return about (refineAxis (*axis, round), normals, points, plane, seen_sectors, hollow);
  };
  std::optional<Eigen::Vector3d> up;
  if (plane)
    up = plane->head<3> ();
  std::optional<SurfaceOfRevolution> surface = withAxisAlong (up, plane || alone ? Hollow::Any : Hollow::Vessel);
  // With a slightly wrong axis, a ring looks like a vessel with thick walls.
  const auto is_thicker = [] (const SurfaceOfRevolution& s, double wall) {
    return s.vessel_->wallThickness () >= wall * s.radius ();
  };
  if (!plane && surface && surface->vessel_ && is_thicker (*surface, thick_wall))
    surface->vessel_.reset ();
  if ((surface && (plane || surface->vessel_)) || (!plane && !alone))
    return surface;

  // Normals of a ball or of a shallow dish determine no axis: the upward direction must be known.
  if (!plane)
  {
    up = rimNormal (normals.lines);
    if (const auto other = up ? withAxisAlong (up, Hollow::Any) : std::nullopt;
        other && other->vessel_ && !is_thicker (*other, slender_wall) &&
        (!surface ||
         static_cast<double> (other->profile_.size ()) > better * static_cast<double> (surface->profile_.size ())))
      return other;
  }
  if (const auto axis = up ? findFootprintAxis (normals.lines, *up) : std::nullopt)
    if (const auto dish = about (*axis, normals, points, plane, 0, plane ? Hollow::Any : Hollow::Dish);
        dish && dish->vessel_)
      return dish;
  return surface;
}

std::optional<SurfaceOfRevolution>
SurfaceOfRevolution::about (const Axis& axis, const NormalLines& normals, const std::vector<OrientedPoint>& points,
                            const std::optional<Eigen::Vector4d>& plane, int least_sectors, Hollow hollow)
{
  std::vector<OrientedPoint> meeting;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (meets (axis, normals.lines[n]))
      meeting.push_back (points[n]);
  SurfaceOfRevolution surface;
  surface.direction_ = axis.direction;
  surface.center_ = normals.origin + normals.size * axis.point;
  if (!surface.findProfile (meeting, normals.size, least_sectors) ||
      static_cast<double> (surface.profile_.size ()) < round_share * static_cast<double> (points.size ()))
    return std::nullopt;
  surface.findVessel (plane, hollow);
  return surface;
}

double
SurfaceOfRevolution::radius () const
{
  double radius = 0.0;
  for (const ProfilePoint& p : profile_)
    radius = std::max (radius, p.position.y ());
  return radius;
}

std::vector<OrientedPoint>
SurfaceOfRevolution::flatEnds () const
{
  std::vector<OrientedPoint> discs;
  const Eigen::Vector3d x = direction_.unitOrthogonal ();
  const Eigen::Vector3d y = direction_.cross (x);
  for (const double sense : {-1.0, 1.0})
  {
    const double end = sense * extent (sense * direction_);
    double radius = 0.0;
    for (const ProfilePoint& p : profile_)
      if (std::abs (p.position.x () - end) < cell_m_)
        radius = std::max (radius, p.position.y ());
    std::size_t near = 0, straight = 0; // of the outer wall
    for (const ProfilePoint& p : profile_)
      if (std::abs (p.position.x () - end) < straight_length * radius && p.position.y () > outer_wall * radius)
      {
        ++near;
        straight += std::abs (p.normal.x ()) < straight_sine;
      }
    if (near == 0 || static_cast<double> (straight) < straight_share * static_cast<double> (near))
      continue;
    const double step = radius / disc_rings;
    for (int j = -disc_rings; j <= disc_rings; ++j)
      for (int i = -disc_rings; i <= disc_rings; ++i)
        if (i * i + j * j <= disc_rings * disc_rings)
        {
          OrientedPoint p;
          p.position = (center_ + end * direction_ + step * (i * x + j * y)).cast<float> ();
          p.normal = (sense * direction_).cast<float> ();
          discs.push_back (p);
        }
  }
  return discs;
}

double
SurfaceOfRevolution::distanceOf (const Eigen::Vector3d& q) const
{
  return q.norm ();
}

Eigen::Vector3d
SurfaceOfRevolution::awayOf (const Eigen::Vector3d& q) const
{
  const double distance = q.norm ();
  return distance > 0.0 ? Eigen::Vector3d (q / distance) : Eigen::Vector3d (Eigen::Vector3d::Zero ());
}

double
SurfaceOfRevolution::reachOf (const Eigen::Vector3d& n, double distance) const
{
  return distance * n.norm ();
}

std::vector<ProfileSurface::Place>
SurfaceOfRevolution::around (double distance, double step_m) const
{
  const Eigen::Vector3d x = direction_.unitOrthogonal ();
  const Eigen::Vector3d y = direction_.cross (x);
  const int count = std::max (1, static_cast<int> (std::ceil (2.0 * M_PI * distance / step_m)));
  std::vector<Place> places;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * M_PI * i / count;
    const Eigen::Vector3d away = std::cos (angle) * x + std::sin (angle) * y;
    places.push_back ({distance * away, away});
  }
  return places;
}

std::vector<OrientedPoint>
SurfaceOfRevolution::onOtherSides (const std::vector<OrientedPoint>& points) const
{
  std::vector<OrientedPoint> copies;
  for (int t = 1; t < turns; ++t)
  {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd (2.0 * M_PI * t / turns, direction_).toRotationMatrix ();
    for (OrientedPoint p : points)
    {
      p.position = (center_ + turn * (p.position.cast<double> () - center_)).cast<float> ();
      p.normal = (turn * p.normal.cast<double> ()).cast<float> ();
      copies.push_back (p);
    }
  }
  return copies;
}

std::shared_ptr<const ProfileSurface>
SurfaceOfRevolution::withoutFloor () const
{
  auto tube = std::make_shared<SurfaceOfRevolution> (*this);
  if (vessel_)
    tube->vessel_ = vessel_->withoutFloor ();
  return tube;
}

} // namespace pcl::cosection
