// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "box_outline.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/priors/shape/profile_surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <complex>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 50;
constexpr double box_share = 0.75;        // of all points
constexpr double sideways = 0.5;          // least component of a wall's normal across the axis
constexpr double least_sideways = 0.05;   // of all points
constexpr double least_rectangular = 0.4; // length of the mean of exp (4 i angle) over walls; 0 for a round wall
constexpr double outlier_share = 0.004;   // of the points: outliers that lie farther out
constexpr double floor_reach = 0.08; // of the size: range of heights of a floor, with an axis by inaccurate normals
constexpr double level = 0.9;        // component of a floor's normal upwards
constexpr double same_axis = 0.98;   // cosine
constexpr double right_angle_cosine = 0.15; // between walls
constexpr double least_inner = 0.05;        // share of the wall points that face inwards
constexpr std::size_t least_floor = 10;
constexpr double along_wall = 0.4; // largest component of a normal along the wall
constexpr double narrowest = 0.1;  // least width, of the length

/** \brief The normal of a plane fit to the floor or the rim, whichever is larger: it is more precise than the normals
 * of their points. */
Eigen::Vector3d
acrossFloor (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up)
{
  std::vector<Eigen::Vector3d> level_points, floor;
  std::vector<double> heights;
  for (const NormalLine& line : lines)
    if (up.dot (line.normal) > level)
    {
      level_points.push_back (line.position);
      heights.push_back (up.dot (line.position));
    }
  if (heights.size () < least_floor)
    return up;
  const double middle = quantile (heights, 0.5);
  for (const Eigen::Vector3d& p : level_points)
    if (std::abs (up.dot (p) - middle) < floor_reach)
      floor.push_back (p);
  return planeNormal (floor, up);
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

/** \brief An open box: a hollow thing with a rectangular outline, such as a tray, a box
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
    const Ptr box = std::make_shared<OpenBox> ();
    box->direction_ = is_standing ? Eigen::Vector3d (plane->head<3> ()) : acrossFloor (normals.lines, up);
    if (!box->findOutline (points, plane))
      return nullptr;
    std::vector<OrientedPoint> alike;
    std::copy_if (points.begin (), points.end (), std::back_inserter (alike),
                  [&] (const OrientedPoint& p) { return box->isAlongWall (box->flat (p)); });
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
    if (inner < least_inner * walls || // no inside was seen
        walls < least_sideways * static_cast<double> (points.size ()) || std::abs (sum) < least_rectangular * walls)
      return false;
    const double turn = 0.25 * std::arg (sum);
    x_ = std::cos (turn) * x_ + std::sin (turn) * y_;
    y_ = direction_.cross (x_);
    Eigen::Array2d half_sizes, middle;
    for (int axis = 0; axis < 2; ++axis)
    {
      std::vector<double> along;
      for (const OrientedPoint& point : points)
        along.push_back (flat (point).position[axis]);
      const double low = quantile (along, outlier_share), high = quantile (along, 1.0 - outlier_share);
      middle[axis] = 0.5 * (low + high);
      half_sizes[axis] = 0.5 * (high - low);
    }
    if (half_sizes.minCoeff () < narrowest * half_sizes.maxCoeff () || !(half_sizes.minCoeff () > 0.0))
      return false;
    center_ += middle.x () * x_ + middle.y () * y_;
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
    outline_ = RectangularOutline (by_walls->half_sizes);
    walls_ = by_walls->walls;
    return true;
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
  RectangularOutline outline_;
  std::size_t walls_ = 0; // number of walls that were seen
};

} // namespace

std::shared_ptr<ProfileSurface>
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
