// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "box_outline.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/priors/shape/profile_surface.h"

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

/** \brief An open box: a hollow thing with a rectangular outline, perhaps with rounded corners, such as a tray, a box
 * without lid or a bin. Its walls are equal on all four sides. */
class OpenBox : public ProfileSurface
{
public:
  using Ptr = std::shared_ptr<OpenBox>;

  /** \return null if there is no such box with this upward direction */
  static Ptr along (const Eigen::Vector3d& up, const std::vector<OrientedPoint>& points,
                    const std::optional<Eigen::Vector4d>& plane)
  {
    const NormalLines normals = normalLinesOf (points);
    const bool is_standing = plane && plane->head<3> ().dot (up) > vertical_cosine;
    const std::optional<Eigen::Vector3d> direction = is_standing ? plane->head<3> () : acrossFloor (normals.lines, up);
    if (!direction)
      return nullptr;
    const Ptr box = std::make_shared<OpenBox> ();
    box->direction_ = *direction;
    if (!box->findOutline (points, plane))
      return nullptr;
    std::vector<double> across;
    for (const OrientedPoint& p : points)
      if (const double component = box->flat (p).normal.norm (); component > sideways)
        across.push_back (component);
    const double steep = quantile (across, 0.5) - blurred;
    std::vector<OrientedPoint> alike;
    std::copy_if (points.begin (), points.end (), std::back_inserter (alike), [&] (const OrientedPoint& p) {
      const FlatPoint f = box->flat (p);
      return box->isAlongWall (f) && (f.normal.norm () < sideways || f.normal.norm () > steep);
    });
    if (!box->findProfile (alike, normals.size, 0) ||
        static_cast<double> (box->profile_.size ()) < box_share * static_cast<double> (points.size ()))
      return nullptr;
    box->findVessel (plane, Hollow::Any);
    return box->vessel_ ? box : nullptr;
  }

  /** \brief Whether it fits the same points better than a box about another axis. */
  bool isBetter (const OpenBox& other) const
  {
    return walls_ > other.walls_ || (walls_ == other.walls_ && profile_.size () > other.profile_.size ());
  }

private:
  /** \brief A point projected along the axis. */
  struct FlatPoint
  {
    Eigen::Vector2d position;
    Eigen::Vector2d normal; // not unit
  };

  /** \brief Align the axes with the walls and find the outline. */
  bool findOutline (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane)
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
    std::vector<Eigen::Vector2d> flat_points;
    for (const OrientedPoint& point : points)
    {
      flat_points.push_back (flat (point).position);
      mean += flat_points.back () / static_cast<double> (points.size ());
    }
    std::complex<double> sum = 0.0;
    double walls = 0.0, inner = 0.0;
    for (const OrientedPoint& point : points)
      if (const FlatPoint f = flat (point); f.normal.norm () > sideways)
      {
        sum += std::polar (1.0, 4.0 * std::atan2 (f.normal.y (), f.normal.x ()));
        walls += 1.0;
        inner += f.normal.dot (f.position - mean) < 0.0;
      }
    if (inner < least_inner * walls || // no inside was seen
        walls < least_sideways * static_cast<double> (points.size ()) || std::abs (sum) < least_rectangular * walls)
      return false;

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
      if (plane && plane->head<3> ().dot (direction_) > vertical_cosine)
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

  bool findCorners (const std::vector<OrientedPoint>& points, const Eigen::Array2d& half_sizes)
  {
    const auto is_on_wall = [this] (const OrientedPoint& p) {
      const FlatPoint f = flat (p);
      return f.normal.norm () > sideways && isAlongWall (f);
    };
    std::ptrdiff_t most = 0;
    RoundedRectangle best;
    for (const double corner : corners)
    {
      outline_ = RoundedRectangle (half_sizes, corner * half_sizes.minCoeff ());
      if (const std::ptrdiff_t count = std::count_if (points.begin (), points.end (), is_on_wall); count > most)
      {
        most = count;
        best = outline_;
      }
    }
    outline_ = best;
    return most > 0;
  }

  FlatPoint flat (const OrientedPoint& point) const
  {
    return {flat (Eigen::Vector3d (point.position.cast<double> () - center_)),
            flat (Eigen::Vector3d (point.normal.cast<double> ()))};
  }

  Eigen::Vector2d flat (const Eigen::Vector3d& q) const { return {x_.dot (q), y_.dot (q)}; }

  bool isAlongWall (const FlatPoint& point) const
  {
    const Eigen::Vector2d away = outline_.away (point.position);
    return std::abs (away.x () * point.normal.y () - away.y () * point.normal.x ()) < along_wall;
  }

  std::shared_ptr<ProfileSurface> clone () const override { return std::make_shared<OpenBox> (*this); }

  std::vector<Eigen::Matrix3d> turns () const override
  {
    const Eigen::Matrix3d over_x = Eigen::Matrix3d::Identity () - 2.0 * x_ * x_.transpose ();
    const Eigen::Matrix3d over_y = Eigen::Matrix3d::Identity () - 2.0 * y_ * y_.transpose ();
    return {over_x, over_y, over_x * over_y};
  }

  double distanceOf (const Eigen::Vector3d& q) const override { return outline_.distance (flat (q)); }

  Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const override
  {
    const Eigen::Vector2d away = outline_.away (flat (q));
    return away.x () * x_ + away.y () * y_;
  }

  double reachOf (const Eigen::Vector3d& n, double distance) const override
  {
    return outline_.reach (flat (n), distance);
  }

  std::vector<Place> around (double distance, double step_m) const override
  {
    std::vector<Place> places;
    for (const Eigen::Vector2d& q : outline_.outline (distance, step_m))
    {
      const Eigen::Vector3d offset = q.x () * x_ + q.y () * y_;
      places.push_back ({offset, awayOf (offset)});
    }
    return places;
  }

  Eigen::Vector3d x_ = Eigen::Vector3d::UnitX (), y_ = Eigen::Vector3d::UnitY (); // along its walls
  RoundedRectangle outline_;
  std::size_t walls_ = 0; // number of walls that were seen
};

} // namespace

std::shared_ptr<const ProfileSurface>
fitOpenBox (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces,
            const std::optional<Eigen::Vector4d>& plane)
{
  if (points.size () < least_points)
    return nullptr;
  if (plane)
    if (const OpenBox::Ptr standing = OpenBox::along (plane->head<3> (), points, plane))
      return standing;
  const auto bestOf = [&] (const std::vector<Eigen::Vector3d>& axes) {
    OpenBox::Ptr best;
    for (const Eigen::Vector3d& up : axes)
      if (const OpenBox::Ptr box = OpenBox::along (up, points, plane); box && (!best || box->isBetter (*best)))
        best = box;
    return best;
  };
  const OpenBox::Ptr best = bestOf (faces); // the floor is one of them, unless it is too deep to be seen
  return best ? best : bestOf (acrossWalls (faces));
}

} // namespace pcl::cosection
