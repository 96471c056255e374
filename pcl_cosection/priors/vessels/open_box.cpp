// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "open_box.h"

#include "pcl_cosection/common/quantile.h"

#include "box_walls.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/priors/shape/normal_axis.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 50;
constexpr double box_share = 0.75;        // of all points
constexpr double sideways = 0.5;          // least component of a wall's normal across the axis
constexpr double least_sideways = 0.05;   // of all points
constexpr double least_rectangular = 0.4; // length of the mean of exp (4 i angle) over walls; 0 for a round wall
constexpr double outlier_share = 0.004;   // of the points: outliers that lie farther out
constexpr double turn_step = 0.0044;      // radians, a quarter of a degree
constexpr int turn_steps = 24;            // in either sense, the largest error of normals
constexpr int wall_rounds = 2;
constexpr double level = 0.9;               // component of a floor's normal upwards
constexpr double same_axis = 0.98;          // cosine
constexpr double right_angle_cosine = 0.15; // between walls
constexpr double least_inner = 0.05;        // share of the wall points that face inwards
constexpr double floor_reach = 0.08; // of the size: range of heights of a floor, with an axis by inaccurate normals
constexpr double same_floor = 0.97;  // least cosine between the mean normal and that of the fitted plane
constexpr std::size_t least_floor = 10;
constexpr double blurred = 0.15;   // so much less sideways than other wall normals are those where wall and floor meet
constexpr double along_wall = 0.4; // largest component of a normal along the wall
constexpr double narrowest = 0.1;  // least width, of the length
constexpr std::array<double, 5> corners = {0.0, 0.15, 0.3, 0.5, 0.75}; // of the half width

/** \brief The normal of the floor from a plane fit to its points, which is more precise than their normals; nothing if
 * the points lie on no plane with about that normal.
 *
 * The rim faces the same way; the larger one of the two is used. */
std::optional<Eigen::Vector3d>
acrossFloor (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up)
{
  std::vector<const NormalLine*> level_lines;
  std::vector<double> heights;
  for (const NormalLine& line : lines)
    if (up.dot (line.normal) > level)
    {
      level_lines.push_back (&line);
      heights.push_back (up.dot (line.position));
    }
  if (heights.size () < least_floor)
    return up;
  std::sort (heights.begin (), heights.end ());
  double middle = 0.0;
  std::ptrdiff_t most = 0;
  for (auto first = heights.begin (); first != heights.end (); ++first)
    if (const std::ptrdiff_t count = std::upper_bound (first, heights.end (), *first + 2.0 * floor_reach) - first;
        count > most)
    {
      most = count;
      middle = *(first + count / 2);
    }
  std::vector<Eigen::Vector3d> floor;
  for (const NormalLine* line : level_lines)
    if (std::abs (up.dot (line->position) - middle) < floor_reach)
      floor.push_back (line->position);
  const Eigen::Vector3d normal = planeNormal (floor, up);
  return normal.dot (up) > same_floor ? std::optional<Eigen::Vector3d> (normal) : std::nullopt;
}

/** \brief Directions that may be upwards, if some of the faces are walls. */
std::vector<Eigen::Vector3d>
acrossWalls (const std::vector<Eigen::Vector3d>& faces)
{
  std::vector<Eigen::Vector3d> axes;
  for (std::size_t a = 0; a < faces.size (); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const double sense : {1.0, -1.0})
      {
        const Eigen::Vector3d axis = sense * faces[a].cross (faces[b]).normalized ();
        const auto is_same = [&] (const Eigen::Vector3d& other) { return axis.dot (other) > same_axis; };
        if (std::abs (faces[a].dot (faces[b])) < right_angle_cosine &&
            std::none_of (axes.begin (), axes.end (), is_same))
          axes.push_back (axis);
      }
  return axes;
}

struct Rectangle
{
  Eigen::Vector2d middle;
  Eigen::Vector2d along; // unit, along its first sides
  Eigen::Array2d half_sizes;
};

/** \brief The smallest rectangle around all points without outliers.
 * \param[in] angle between the first axis and a side, by normals: approximate */
Rectangle
leastRectangle (const std::vector<Eigen::Vector2d>& points, double angle)
{
  Rectangle least;
  double least_area = std::numeric_limits<double>::infinity ();
  std::vector<double> ahead (points.size ()), aside (points.size ());
  for (int step = -turn_steps; step <= turn_steps; ++step)
  {
    const double turned = angle + step * turn_step;
    const Eigen::Vector2d u (std::cos (turned), std::sin (turned)), v (-u.y (), u.x ());
    for (std::size_t n = 0; n < points.size (); ++n)
    {
      ahead[n] = u.dot (points[n]);
      aside[n] = v.dot (points[n]);
    }
    const Eigen::Array2d low (quantile (ahead, outlier_share), quantile (aside, outlier_share));
    const Eigen::Array2d high (quantile (ahead, 1.0 - outlier_share), quantile (aside, 1.0 - outlier_share));
    if (const double area = (high - low).prod (); area < least_area)
    {
      least_area = area;
      const Eigen::Array2d middle = 0.5 * (low + high);
      least = {middle.x () * u + middle.y () * v, u, 0.5 * (high - low)};
    }
  }
  return least;
}

} // namespace

std::optional<OpenBox>
OpenBox::fit (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces,
              const std::optional<Eigen::Vector4d>& plane)
{
  if (points.size () < least_points)
    return std::nullopt;
  if (plane)
    if (std::optional<OpenBox> standing = along (plane->head<3> (), points, plane))
      return standing;
  const auto bestOf = [&] (const std::vector<Eigen::Vector3d>& axes) {
    std::optional<OpenBox> best;
    for (const Eigen::Vector3d& up : axes)
      if (std::optional<OpenBox> box = along (up, points, plane); box && (!best || box->isBetter (*best)))
        best = std::move (box);
    return best;
  };
  std::optional<OpenBox> best = bestOf (faces); // the floor is one of them, unless it is too deep to be seen
  if (!best)
    best = bestOf (acrossWalls (faces));
  return best;
}

std::optional<OpenBox>
OpenBox::along (const Eigen::Vector3d& up, const std::vector<OrientedPoint>& points,
                const std::optional<Eigen::Vector4d>& plane)
{
  const NormalLines normals = normalLinesOf (points);
  const bool is_standing = plane && plane->head<3> ().dot (up) > vertical;
  const std::optional<Eigen::Vector3d> direction = is_standing ? plane->head<3> () : acrossFloor (normals.lines, up);
  if (!direction)
    return std::nullopt;
  OpenBox box;
  box.direction_ = *direction;
  if (!box.findOutline (points, plane))
    return std::nullopt;
  std::vector<double> across;
  for (const OrientedPoint& p : points)
    if (const double component = box.flat (p).normal.norm (); component > sideways)
      across.push_back (component);
  const double steep = quantile (across, 0.5) - blurred;
  std::vector<OrientedPoint> alike;
  std::copy_if (points.begin (), points.end (), std::back_inserter (alike), [&] (const OrientedPoint& p) {
    const FlatPoint f = box.flat (p);
    return box.isAlongWall (f) && (f.normal.norm () < sideways || f.normal.norm () > steep);
  });
  if (!box.findProfile (alike, normals.size, 0) ||
      static_cast<double> (box.profile_.size ()) < box_share * static_cast<double> (points.size ()))
    return std::nullopt;
  box.findVessel (plane, Hollow::Any);
  if (!box.vessel_)
    return std::nullopt;
  return box;
}

bool
OpenBox::isBetter (const OpenBox& other) const
{
  return walls_ > other.walls_ || (walls_ == other.walls_ && profile_.size () > other.profile_.size ());
}

bool
OpenBox::findOutline (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane)
{
  center_ = points.front ().position.cast<double> ();
  std::vector<double> wall_heights;
  for (const OrientedPoint& point : points)
    if (std::abs (direction_.dot (point.normal.cast<double> ())) < 1.0 - sideways)
      wall_heights.push_back (direction_.dot (point.position.cast<double> () - center_));
  if (wall_heights.empty ())
    return false;
  center_ += quantile (wall_heights, 0.5) * direction_;
  x_ = direction_.unitOrthogonal ();
  y_ = direction_.cross (x_);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero ();
  for (const OrientedPoint& point : points)
    mean += flat (point).position / static_cast<double> (points.size ());
  std::complex<double> sum = 0.0;
  double walls = 0.0, inner = 0.0;
  for (const OrientedPoint& point : points)
    if (const FlatPoint f = flat (point); f.normal.norm () > sideways)
    {
      sum += std::polar (1.0, 4.0 * std::atan2 (f.normal.y (), f.normal.x ()));
      walls += 1.0;
      inner += f.normal.dot (f.position - mean) < 0.0;
    }
  if (inner < least_inner * walls) // no inside was seen
    return false;
  if (walls < least_sideways * static_cast<double> (points.size ()) || std::abs (sum) < least_rectangular * walls)
    return false;

  std::vector<Eigen::Vector2d> flat_points;
  for (const OrientedPoint& point : points)
    flat_points.push_back (flat (point).position);
  const Rectangle about = leastRectangle (flat_points, 0.25 * std::arg (sum));
  Eigen::Array2d half_sizes = about.half_sizes;
  if (half_sizes.minCoeff () < narrowest * half_sizes.maxCoeff () || !(half_sizes.minCoeff () > 0.0))
    return false;
  center_ += about.middle.x () * x_ + about.middle.y () * y_;
  x_ = about.along.x () * x_ + about.along.y () * y_;
  y_ = direction_.cross (x_);
  for (int r = 0; r < wall_rounds; ++r)
  {
    std::vector<BoxPoint> box_points;
    for (const OrientedPoint& p : points)
    {
      const Eigen::Vector3d q = p.position.cast<double> () - center_, n = p.normal.cast<double> ();
      box_points.push_back (
          {{x_.dot (q), y_.dot (q), direction_.dot (q)}, {x_.dot (n), y_.dot (n), direction_.dot (n)}});
    }
    std::optional<double> bottom;
    if (plane && plane->head<3> ().dot (direction_) > vertical)
      bottom = -plane->head<3> ().dot (center_) - (*plane)[3];
    const std::optional<BoxOutline> by_walls = outlineByWalls (box_points, half_sizes, bottom);
    if (!by_walls)
      return false;
    center_ += by_walls->middle.x () * x_ + by_walls->middle.y () * y_;
    half_sizes = by_walls->half_sizes;
    walls_ = by_walls->walls;
  }
  return findCorners (points, half_sizes);
}

bool
OpenBox::findCorners (const std::vector<OrientedPoint>& points, const Eigen::Array2d& half_sizes)
{
  std::ptrdiff_t most = 0;
  for (const double corner : corners)
  {
    OpenBox other = *this;
    other.outline_ = RoundedRectangle (half_sizes, corner * half_sizes.minCoeff ());
    const auto is_on_wall = [&] (const OrientedPoint& p) {
      const FlatPoint f = other.flat (p);
      return f.normal.norm () > sideways && other.isAlongWall (f);
    };
    if (const std::ptrdiff_t count = std::count_if (points.begin (), points.end (), is_on_wall); count > most)
    {
      most = count;
      outline_ = other.outline_;
    }
  }
  return most > 0;
}

OpenBox::FlatPoint
OpenBox::flat (const OrientedPoint& point) const
{
  return {flat (Eigen::Vector3d (point.position.cast<double> () - center_)),
          flat (Eigen::Vector3d (point.normal.cast<double> ()))};
}

bool
OpenBox::isAlongWall (const FlatPoint& point) const
{
  const Eigen::Vector2d away = outline_.away (point.position);
  return std::abs (away.x () * point.normal.y () - away.y () * point.normal.x ()) < along_wall;
}

double
OpenBox::distanceOf (const Eigen::Vector3d& q) const
{
  return outline_.distance (flat (q));
}

Eigen::Vector3d
OpenBox::awayOf (const Eigen::Vector3d& q) const
{
  const Eigen::Vector2d away = outline_.away (flat (q));
  return away.x () * x_ + away.y () * y_;
}

double
OpenBox::reachOf (const Eigen::Vector3d& n, double distance) const
{
  return outline_.reach (flat (n), distance);
}

std::vector<ProfileSurface::Place>
OpenBox::around (double distance, double step_m) const
{
  std::vector<Place> places;
  for (const Eigen::Vector2d& q : outline_.outline (distance, step_m))
  {
    const Eigen::Vector3d offset = q.x () * x_ + q.y () * y_;
    places.push_back ({offset, awayOf (offset)});
  }
  return places;
}

std::vector<OrientedPoint>
OpenBox::onOtherSides (const std::vector<OrientedPoint>& points) const
{
  std::vector<OrientedPoint> copies;
  const Eigen::Matrix3d over_x = Eigen::Matrix3d::Identity () - 2.0 * x_ * x_.transpose ();
  const Eigen::Matrix3d over_y = Eigen::Matrix3d::Identity () - 2.0 * y_ * y_.transpose ();
  for (const Eigen::Matrix3d& mirror : {over_x, over_y, Eigen::Matrix3d (over_x * over_y)})
    for (OrientedPoint p : points)
    {
      p.position = (center_ + mirror * (p.position.cast<double> () - center_)).cast<float> ();
      p.normal = (mirror * p.normal.cast<double> ()).cast<float> ();
      copies.push_back (p);
    }
  return copies;
}

std::shared_ptr<const ProfileSurface>
OpenBox::withoutFloor () const
{
  auto frame = std::make_shared<OpenBox> (*this);
  if (vessel_)
    frame->vessel_ = vessel_->withoutFloor ();
  return frame;
}

} // namespace pcl::cosection
