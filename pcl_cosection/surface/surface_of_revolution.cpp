// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "surface_of_revolution.h"

#include "axis_refinement.h"
#include "ball_fit.h"
#include "dish_profile.h"
#include "footprint_axis.h"
#include "normal_axis.h"
#include "vessel_profile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr std::size_t least_points = 50;
constexpr double round_share = 0.75; // of all points
constexpr double sunk = 0.1;         // of the radius: no ball lies deeper in what it stands on
constexpr double max_radius = 1.5;   // of the size
constexpr double cell_size = 0.05;   // of the size, of the profile
constexpr int sectors = 36;          // around the axis
constexpr int round_sectors = 5;     // in a row: what is seen in so many is no handle
constexpr int seen_sectors = 8;      // in a row: a thing of which less was seen may be anything
constexpr double straight_length = 0.5; // of the radius: a wall so long and so straight ends in a flat face
constexpr double straight_sine = 0.2;   // between the wall and the axis
constexpr double straight_share = 0.8;  // of the wall's points
constexpr double outer_wall = 0.9;      // of the radius
constexpr int disc_rings = 24;
constexpr double least_step = 0.05;  // of a cell: between points of what is deep inside a vessel
constexpr double slender_wall = 0.2; // of the radius
constexpr double thick_wall = 0.3;
constexpr double better = 1.02;      // of the points: so many more must an axis hold to be told by the rim
constexpr int turns = 12;            // all around
constexpr double stray_share = 0.002; // of the points, may lie farther out

int
longestRun (const std::array<bool, sectors>& seen)
{
  int run = 0, longest = 0;
  for (int s = 0; s < 2 * sectors; ++s)
  {
    run = seen[s % sectors] ? run + 1 : 0;
    longest = std::max (longest, std::min (run, sectors));
  }
  return longest;
}

} // namespace

std::optional<SurfaceOfRevolution>
SurfaceOfRevolution::fit (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone)
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
      std::optional<SurfaceOfRevolution> surface = about (axisOf (*ball, normals.lines), normals, points, plane, seen_sectors, Hollow::None);
      if (surface)
        surface->is_ball_ = true;
      return surface;
    }
  }
  const auto withAxisAlong = [&] (const std::optional<Eigen::Vector3d>& direction, Hollow hollow) -> std::optional<SurfaceOfRevolution> {
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
  // About an axis that is a little wrong, rings look like vessels with thick walls.
  const auto is_thicker = [] (const SurfaceOfRevolution& s, double wall) { return s.vessel_->wallThickness () >= wall * s.radius (); };
  if (!plane && surface && surface->vessel_ && is_thicker (*surface, thick_wall))
    surface->vessel_.reset ();
  if ((surface && (plane || surface->vessel_)) || (!plane && !alone))
    return surface;

  // Curved like a ball, or too shallow for an axis: which way is up must be known.
  if (!plane)
  {
    up = rimNormal (normals.lines);
    if (const auto other = up ? withAxisAlong (up, Hollow::Any) : std::nullopt;
        other && other->vessel_ && !is_thicker (*other, slender_wall) &&
        (!surface || static_cast<double> (other->profile_.size ()) > better * static_cast<double> (surface->profile_.size ())))
      return other;
  }
  if (const auto axis = up ? findFootprintAxis (normals.lines, *up) : std::nullopt)
    if (const auto dish = about (*axis, normals, points, plane, 0, plane ? Hollow::Any : Hollow::Dish); dish && dish->vessel_)
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
  if (hollow == Hollow::None)
    return surface;
  std::optional<StandingPlane> standing;
  if (const double rise = plane ? plane->head<3> ().dot (surface.direction_) : 0.0; std::abs (rise) > upright)
    standing = StandingPlane{-(plane->head<3> ().dot (surface.center_) + (*plane)[3]) / rise, rise > 0.0 ? 1.0 : -1.0};
  if (hollow != Hollow::Dish)
    surface.vessel_ = VesselProfile::find (surface.profile_, surface.cell_m_, standing);
  if (!surface.vessel_ && hollow != Hollow::Vessel && (standing || !plane))
    surface.vessel_ = DishProfile::find (surface.profile_, surface.cell_m_, standing);
  return surface;
}

Eigen::Vector2d
SurfaceOfRevolution::profileOf (const Eigen::Vector3d& position) const
{
  const Eigen::Vector3d q = position - center_;
  const double height = direction_.dot (q);
  return {height, (q - height * direction_).norm ()};
}

Eigen::Vector2d
SurfaceOfRevolution::profileNormalOf (const OrientedPoint& point) const
{
  const Eigen::Vector3d q = point.position.cast<double> () - center_;
  const Eigen::Vector3d n = point.normal.cast<double> ();
  const Eigen::Vector3d away = q - direction_.dot (q) * direction_;
  const double radius = away.norm ();
  return {direction_.dot (n), radius > 0.0 ? n.dot (away) / radius : 0.0};
}

bool
SurfaceOfRevolution::findProfile (const std::vector<OrientedPoint>& points, double size, int least_sectors)
{
  std::vector<ProfilePoint> profile;
  Eigen::AlignedBox2d box;
  for (const OrientedPoint& p : points)
  {
    profile.push_back ({profileOf (p.position.cast<double> ()), profileNormalOf (p)});
    box.extend (profile.back ().position);
  }
  if (points.empty () || box.max ().y () > max_radius * size)
    return false;
  const double middle = box.center ().x ();
  center_ += middle * direction_;
  box.translate (Eigen::Vector2d (-middle, 0.0));
  for (ProfilePoint& p : profile)
    p.position.x () -= middle;
  cell_m_ = cell_size * size;
  first_ = box.min ();
  cells_ = (box.sizes () / cell_m_).array ().floor ().cast<int> () + 1;
  std::vector<std::array<bool, sectors>> seen (static_cast<std::size_t> (cells_.prod ()), std::array<bool, sectors>{});
  std::array<bool, sectors> seen_anywhere{};
  const Eigen::Vector3d x = direction_.unitOrthogonal ();
  const Eigen::Vector3d y = direction_.cross (x);
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const Eigen::Vector3d q = points[n].position.cast<double> () - center_;
    const double angle = std::atan2 (y.dot (q), x.dot (q)) / (2.0 * M_PI) + 0.5;
    const int sector = std::min (static_cast<int> (angle * sectors), sectors - 1);
    const Eigen::Vector2i cell = cellOf (profile[n].position);
    for (int j = std::max (0, cell.y () - 1); j <= std::min (cells_.y () - 1, cell.y () + 1); ++j)
      for (int i = std::max (0, cell.x () - 1); i <= std::min (cells_.x () - 1, cell.x () + 1); ++i)
        seen[indexOf ({i, j})][sector] = true;
    if (facesSideways (direction_, points[n].normal.cast<double> ()))
      seen_anywhere[sector] = true;
  }
  if (longestRun (seen_anywhere) < least_sectors)
    return false;
  round_.resize (seen.size ());
  for (std::size_t c = 0; c < seen.size (); ++c)
    round_[c] = longestRun (seen[c]) >= round_sectors;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (holds (points[n].position.cast<double> ()))
      profile_.push_back (profile[n]);
  return !profile_.empty ();
}

Eigen::Vector2i
SurfaceOfRevolution::cellOf (const Eigen::Vector2d& profile) const
{
  return ((profile - first_) / cell_m_).array ().floor ().cast<int> ();
}

std::size_t
SurfaceOfRevolution::indexOf (const Eigen::Vector2i& cell) const
{
  return static_cast<std::size_t> (cell.y ()) * cells_.x () + cell.x ();
}

bool
SurfaceOfRevolution::holds (const Eigen::Vector3d& position) const
{
  const Eigen::Vector2d cell = ((profileOf (position) - first_) / cell_m_).array ().floor ();
  return (cell.array () >= 0.0).all () && (cell.array () < cells_.cast<double> ().array ()).all () &&
         round_[indexOf (cell.cast<int> ())];
}

double
SurfaceOfRevolution::radius () const
{
  double radius = 0.0;
  for (const ProfilePoint& p : profile_)
    radius = std::max (radius, p.position.y ());
  return radius;
}

double
SurfaceOfRevolution::extent (const Eigen::Vector3d& n) const
{
  const double rise = direction_.dot (n);
  const double reach = (n - rise * direction_).norm ();
  std::vector<double> extents;
  extents.reserve (profile_.size ());
  for (const ProfilePoint& p : profile_)
    extents.push_back (rise * p.position.x () + reach * p.position.y ());
  const auto end = extents.end () - 1 - static_cast<std::ptrdiff_t> (stray_share * static_cast<double> (extents.size ()));
  std::nth_element (extents.begin (), end, extents.end ());
  return *end;
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

std::vector<OrientedPoint>
SurfaceOfRevolution::turned (const std::vector<OrientedPoint>& points) const
{
  std::vector<OrientedPoint> copies;
  for (int t = 1; t < turns; ++t)
  {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd (2.0 * M_PI * t / turns, direction_).toRotationMatrix ();
    for (OrientedPoint p : points)
    {
      const Eigen::Vector3d position = p.position.cast<double> ();
      if (!holds (position) || (vessel_ && !vessel_->holds ({profileOf (position), profileNormalOf (p)})))
        continue;
      p.position = (center_ + turn * (position - center_)).cast<float> ();
      p.normal = (turn * p.normal.cast<double> ()).cast<float> ();
      copies.push_back (p);
    }
  }
  return copies;
}

VesselPart
SurfaceOfRevolution::partOf (const OrientedPoint& point) const
{
  return vessel_ ? vessel_->partOf ({profileOf (point.position.cast<double> ()), profileNormalOf (point)}) : VesselPart::Outer;
}

double
SurfaceOfRevolution::depthInCavity (const Eigen::Vector3d& position) const
{
  return vessel_ ? vessel_->depthInCavity (profileOf (position)) : 0.0;
}

double
SurfaceOfRevolution::depthUnder (const Eigen::Vector3d& position) const
{
  return vessel_ ? vessel_->depthUnder (profileOf (position)) : 0.0;
}

std::vector<OrientedPoint>
SurfaceOfRevolution::depths (double step_m) const
{
  std::vector<OrientedPoint> points;
  if (!vessel_)
    return points;
  const Eigen::Vector3d x = direction_.unitOrthogonal ();
  const Eigen::Vector3d y = direction_.cross (x);
  const double step = std::max (step_m, least_step * cell_m_);
  for (const ProfilePoint& p : vessel_->depths (step))
  {
    const int count = std::max (1, static_cast<int> (std::ceil (2.0 * M_PI * p.position.y () / step)));
    for (int i = 0; i < count; ++i)
    {
      const double angle = 2.0 * M_PI * i / count;
      const Eigen::Vector3d away = std::cos (angle) * x + std::sin (angle) * y;
      OrientedPoint point;
      point.position = (center_ + p.position.x () * direction_ + p.position.y () * away).cast<float> ();
      point.normal = (p.normal.x () * direction_ + p.normal.y () * away).cast<float> ();
      points.push_back (point);
    }
  }
  return points;
}

} // namespace cosection
} // namespace pcl
