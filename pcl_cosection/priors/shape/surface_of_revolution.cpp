// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "axes.h"
#include "footprint_axis.h"
#include "pcl_cosection/common/robust_weights.h"
#include "profile_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 50;
constexpr double round_share = 0.75; // of all points
constexpr double sunk = 0.1;         // of the radius: largest depth of a ball in its support plane
constexpr int seen_sectors = 8;      // next to each other: if fewer were seen, the thing may have any shape
constexpr double slender_wall = 0.2; // of the radius
constexpr double thick_wall = 0.3;
constexpr double better = 1.02;   // an axis by the rim must hold so many times the points of another axis
constexpr int copies_around = 12; // all around

// Fit of a ball.
constexpr int rounds = 12;             // of reweighting
constexpr double outlier_scale = 0.04; // of NormalLines::size: a distance from the surface with half weight
constexpr double facing_sine = 0.2;    // largest sine between a normal and the radial direction ...
constexpr double facing_reach = 0.02;  // ... plus this distance of the normal from the centre, of the size
constexpr double facing_share = 0.8;   // of the points
constexpr double inward_share = 0.05;  // of the points: with more facing inward, it is the inside of a bowl
constexpr double max_deviation = 0.05; // of the radius, root mean square, without noise
constexpr double max_noise = 0.15;     // of the radius, root mean square, of all points
constexpr double max_radius = 1.0;     // of the size: too small a part of a larger ball was seen
// Cells along the edge of a cube around the ball. Noise averages out in the cells of its faces, shape does not.
constexpr int cells = 4;

struct Ball
{
  Eigen::Vector3d center;
  double radius;
};

/** \brief Number of the cell of a cube's faces to which a direction points. */
std::size_t
cellOf (const Eigen::Vector3d& direction)
{
  Eigen::Index axis;
  const double largest = direction.cwiseAbs ().maxCoeff (&axis);
  const auto along = [&] (Eigen::Index a) {
    const double place = largest > 0.0 ? 0.5 * (direction[a % 3] / largest + 1.0) : 0.0;
    return std::min (static_cast<int> (place * cells), cells - 1);
  };
  const int face = 2 * static_cast<int> (axis) + (direction[axis] > 0.0);
  return static_cast<std::size_t> ((face * cells + along (axis + 1)) * cells + along (axis + 2));
}

/** \brief Whether distances of points from a ball's surface are small: root mean squares over all points (noise and
 * shape), and of their means over small ranges of directions (the shape without noise). */
bool
fitsWell (const Ball& ball, const std::vector<NormalLine>& lines)
{
  struct Cell
  {
    double sum = 0.0, squares = 0.0;
    int points = 0;
  };
  std::array<Cell, 6 * cells * cells> by_direction;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3d from_center = line.position - ball.center;
    const double deviation = from_center.norm () - ball.radius;
    Cell& cell = by_direction[cellOf (from_center)];
    cell.sum += deviation;
    cell.squares += deviation * deviation;
    ++cell.points;
  }
  double all_squares = 0.0, shape_squares = 0.0, points = 0.0;
  for (const Cell& cell : by_direction)
    if (cell.points > 0)
    {
      all_squares += cell.squares;
      shape_squares += cell.sum * cell.sum / cell.points;
      points += cell.points;
    }
  return !(std::sqrt (shape_squares / points) > max_deviation * ball.radius) &&
         !(std::sqrt (all_squares / points) > max_noise * ball.radius);
}

/** \brief Fit a ball to positions, as noisy normals alone make it too small. */
Ball
fittedBall (Ball ball, const std::vector<NormalLine>& lines)
{
  for (int r = 0; r < rounds; ++r)
  {
    Eigen::Matrix4d left = Eigen::Matrix4d::Zero ();
    Eigen::Vector4d right = Eigen::Vector4d::Zero ();
    for (const NormalLine& line : lines)
    {
      const Eigen::Vector3d from_center = line.position - ball.center;
      const double residual = from_center.norm () - ball.radius;
      const Eigen::Vector4d slope = from_center.normalized ().homogeneous ();
      const double weight = cauchyWeight (residual / outlier_scale);
      left += weight * slope * slope.transpose ();
      right += weight * residual * slope;
    }
    const Eigen::Vector4d step = left.ldlt ().solve (right);
    ball.center += step.head<3> ();
    ball.radius += step[3];
  }
  return ball;
}

/** \brief Fit a ball to points.
 * \return nothing if they do not lie on a ball, face its inside, or cover too small a part of it */
std::optional<Ball>
findBall (const std::vector<NormalLine>& lines)
{
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d right = Eigen::Vector3d::Zero ();
  for (const NormalLine& line : lines)
  {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity () - line.normal * line.normal.transpose ();
    left += across;
    right += across * line.position;
  }
  Ball ball{left.ldlt ().solve (right), 0.0};
  for (const NormalLine& line : lines)
    ball.radius += (line.position - ball.center).norm () / static_cast<double> (lines.size ());
  ball = fittedBall (ball, lines);
  if (!(ball.radius < max_radius))
    return std::nullopt;
  std::size_t good = 0, inward = 0;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3d from_center = line.position - ball.center;
    const bool outward = from_center.dot (line.normal) > 0.0;
    inward += !outward;
    good += outward && from_center.cross (line.normal).norm () < facing_sine * ball.radius + facing_reach;
  }
  const auto all = static_cast<double> (lines.size ());
  if (static_cast<double> (good) < facing_share * all || static_cast<double> (inward) > inward_share * all ||
      !fitsWell (ball, lines))
    return std::nullopt;
  return ball;
}

/** \brief An axis of a ball about which a half turn takes its seen side to the hidden one, as vertical as can be: so it
 * turns with the scene. */
Axis
axisOf (const Ball& ball, const std::vector<NormalLine>& lines, const std::optional<Eigen::Vector4d>& plane)
{
  Eigen::Vector3d seen = Eigen::Vector3d::Zero ();
  for (const NormalLine& line : lines)
    seen += line.normal;
  if (!(seen.norm () > 0.0))
    return {Eigen::Vector3d::UnitX (), ball.center};
  const Eigen::Vector3d up = plane ? Eigen::Vector3d (plane->head<3> ()) : Eigen::Vector3d::Zero ();
  const Eigen::Vector3d across = up - up.dot (seen) / seen.squaredNorm () * seen;
  return {across.norm () > Eigen::NumTraits<double>::dummy_precision () ? Eigen::Vector3d (across.normalized ())
                                                                        : Eigen::Vector3d (seen.unitOrthogonal ()),
          ball.center};
}

/** \brief A surface of revolution: a bottle, a can, a bowl, a ball, a mug without its handle. */
class SurfaceOfRevolution : public ProfileSurface
{
public:
  using Ptr = std::shared_ptr<SurfaceOfRevolution>;

  /** \brief As fitSurfaceOfRevolution (). */
  static Ptr fit (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane, bool alone)
  {
    if (points.size () < least_points)
      return nullptr;
    const NormalLines normals = normalLinesOf (points);
    if (normals.lines.empty ())
      return nullptr;
    if (const std::optional<Ball> ball = findBall (normals.lines))
    {
      const double radius = normals.size * ball->radius;
      const Eigen::Vector3d center = normals.origin + normals.size * ball->center;
      if (!plane || plane->head<3> ().dot (center) + (*plane)[3] > (1.0 - sunk) * radius)
      {
        const Ptr surface = about (axisOf (*ball, normals.lines, plane), normals, points, plane, seen_sectors,
                                   Hollow::None);
        if (surface)
          surface->is_ball_ = true;
        return surface;
      }
    }
    const auto withAxisAlong = [&] (const std::optional<Eigen::Vector3d>& direction, Hollow hollow) -> Ptr {
      const std::optional<Axis> axis = findAxis (normals.lines, direction);
      if (!axis)
        return nullptr;
      std::vector<NormalLine> round;
      std::copy_if (normals.lines.begin (), normals.lines.end (), std::back_inserter (round),
                    [&] (const NormalLine& line) { return meets (*axis, line); });
      return about (refineAxis (*axis, round), normals, points, plane, seen_sectors, hollow);
    };
    std::optional<Eigen::Vector3d> up;
    if (plane)
      up = plane->head<3> ();
    const Ptr surface = withAxisAlong (up, plane || alone ? Hollow::Any : Hollow::Vessel);
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
      if (const auto other = up ? withAxisAlong (up, Hollow::Any) : nullptr;
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

  bool isBall () const override { return is_ball_; }

private:
  /** \brief Fit with a known axis.
   * \param[in] least_sectors around the axis, next to each other, in which points must face sideways
   * \return nothing if too few points belong to the surface */
  static Ptr about (const Axis& axis, const NormalLines& normals, const std::vector<OrientedPoint>& points,
                    const std::optional<Eigen::Vector4d>& plane, int least_sectors, Hollow hollow)
  {
    std::vector<OrientedPoint> meeting;
    for (std::size_t n = 0; n < points.size (); ++n)
      if (meets (axis, normals.lines[n]))
        meeting.push_back (points[n]);
    const Ptr surface = std::make_shared<SurfaceOfRevolution> ();
    surface->direction_ = axis.direction;
    surface->center_ = normals.origin + normals.size * axis.point;
    if (!surface->findProfile (meeting, normals.size, least_sectors) ||
        static_cast<double> (surface->profile_.size ()) < round_share * static_cast<double> (points.size ()))
      return nullptr;
    surface->findVessel (plane, hollow);
    return surface;
  }

  /** \brief Largest radius of the profile, metres. */
  double radius () const
  {
    double radius = 0.0;
    for (const ProfilePoint& p : profile_)
      radius = std::max (radius, p.position.y ());
    return radius;
  }

  std::vector<Eigen::Matrix3d> turns () const override
  {
    std::vector<Eigen::Matrix3d> turns;
    for (int t = 1; t < copies_around; ++t)
      turns.push_back (Eigen::AngleAxisd (2.0 * M_PI * t / copies_around, direction_).toRotationMatrix ());
    return turns;
  }

  double distanceOf (const Eigen::Vector3d& q) const override { return q.norm (); }

  Eigen::Vector3d awayOf (const Eigen::Vector3d& q) const override
  {
    const double distance = q.norm ();
    return distance > 0.0 ? Eigen::Vector3d (q / distance) : Eigen::Vector3d (Eigen::Vector3d::Zero ());
  }

  double reachOf (const Eigen::Vector3d& n, double distance) const override { return distance * n.norm (); }

  std::vector<Place> around (double distance, double step_m) const override
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

  bool is_ball_ = false;
};

} // namespace

std::shared_ptr<ProfileSurface>
fitSurfaceOfRevolution (const std::vector<OrientedPoint>& points, const std::optional<Eigen::Vector4d>& plane,
                        bool alone)
{
  return SurfaceOfRevolution::fit (points, plane, alone);
}

} // namespace pcl::cosection
