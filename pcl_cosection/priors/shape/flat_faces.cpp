// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "flat_faces.h"

#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double face_share = 0.03;         // of the points: smaller faces do not count
constexpr double face_cosine = 0.966;       // 15 degrees
constexpr std::size_t few_faces = 3;        // the largest
constexpr double few_faces_share = 0.7;     // of the points
constexpr double right_angle_cosine = 0.15; // between faces
constexpr double cuboid_cosine = 0.92;      // between the normal of a point on a face and the face's mean normal
constexpr double cuboid_share = 0.85;       // of the points, on faces at right angles

// Vertical walls.
constexpr double wall_rise = 0.17; // largest component of a wall's normal upwards
constexpr double level = 0.97;     // least component of a top's normal upwards
constexpr int outline_directions = 72;
constexpr double outliers = 0.002; // of the points: those that may lie beyond the outline
constexpr double near_wall = 0.15; // of the width across a wall: points so near show its height
constexpr double top_outliers = 0.02;
constexpr double least_top = 0.1;     // of the points
constexpr double lowest_top = 0.1;    // of the points of the top: outliers below it
constexpr double level_rise = 0.1;    // of the height: largest range of heights of one top
constexpr int edge_cells = 3;         // neighbourhood of a cell of the top that shows whether the top ends there
constexpr std::size_t least_near = 8; // cells in it; a cell with fewer is an outlier
constexpr double least_side = 0.8;    // cells: offset of their mean at an edge; that of a half disc is larger
constexpr double parallel = 1e-9;     // sine between walls

/** \brief The largest component along a direction, without outliers. */
double
reach (const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& direction)
{
  if (places.empty ())
    return -std::numeric_limits<double>::infinity ();
  std::vector<double> along;
  along.reserve (places.size ());
  for (const Eigen::Vector2d& p : places)
    along.push_back (direction.dot (p));
  return quantile (along, 1.0 - outliers);
}

} // namespace

std::vector<Eigen::Vector3d>
evenDirections (int count, const Eigen::Matrix3d& axes)
{
  std::vector<Eigen::Vector3d> directions;
  const double golden = M_PI * (3.0 - std::sqrt (5.0));
  for (int n = 0; n < count; ++n)
  {
    const double z = 1.0 - (2.0 * n + 1.0) / count;
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d direction (r * std::cos (golden * n), r * std::sin (golden * n), z);
    if ((direction.array () < 0.0).any ())
      continue;
    for (int octant = 0; octant < 8; ++octant)
    {
      const Eigen::Array3d sense ((octant & 1) ? -1.0 : 1.0, (octant & 2) ? -1.0 : 1.0, (octant & 4) ? -1.0 : 1.0);
      directions.push_back (axes * (sense * direction.array ()).matrix ());
    }
  }
  return directions;
}

std::vector<Eigen::Vector3d>
faceNormals (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& bins)
{
  std::vector<Eigen::Vector3d> sums (bins.size (), Eigen::Vector3d::Zero ());
  std::vector<int> counts (bins.size (), 0);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d n = point.normal.cast<double> ();
    std::size_t nearest = 0;
    double largest = bins[0].dot (n);
    for (std::size_t b = 1; b < bins.size (); ++b)
      if (const double cosine = bins[b].dot (n); cosine > largest)
      {
        nearest = b;
        largest = cosine;
      }
    sums[nearest] += n;
    ++counts[nearest];
  }
  std::vector<Eigen::Vector3d> faces;
  while (true)
  {
    const std::ptrdiff_t fullest = std::max_element (counts.begin (), counts.end ()) - counts.begin ();
    if (counts[fullest] < face_share * static_cast<double> (points.size ()))
      return faces;
    const Eigen::Vector3d rough = sums[fullest].normalized ();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    for (const OrientedPoint& point : points)
      if (point.normal.cast<double> ().dot (rough) > face_cosine)
        sum += point.normal.cast<double> ();
    counts[fullest] = 0;
    if (!(sum.norm () > 0.0))
      continue;
    faces.push_back (sum.normalized ());
    for (std::size_t b = 0; b < bins.size (); ++b)
      if (bins[b].dot (faces.back ()) > face_cosine)
        counts[b] = 0;
  }
}

bool
prevail (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces)
{
  const auto on_face = [&] (const OrientedPoint& p) {
    const auto is_its = [&] (const Eigen::Vector3d& face) { return face.dot (p.normal.cast<double> ()) > face_cosine; };
    return std::any_of (faces.begin (),
                        faces.begin () + static_cast<std::ptrdiff_t> (std::min (few_faces, faces.size ())), is_its);
  };
  const std::ptrdiff_t count = std::count_if (points.begin (), points.end (), on_face);
  return static_cast<double> (count) > few_faces_share * static_cast<double> (points.size ());
}

bool
isCuboid (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces)
{
  if (faces.empty ())
    return false;
  const auto across = [&] (const Eigen::Vector3d& n) { return std::abs (n.dot (faces[0])) < right_angle_cosine; };
  const auto second = std::find_if (faces.begin (), faces.end (), across);
  if (second == faces.end ())
    return false;
  const Eigen::Vector3d third = faces[0].cross (*second).normalized ();
  const auto on_face = [&] (const OrientedPoint& p) {
    const Eigen::Vector3d n = p.normal.cast<double> ();
    return std::max ({std::abs (n.dot (faces[0])), std::abs (n.dot (*second)), std::abs (n.dot (third))}) >
           cuboid_cosine;
  };
  const std::ptrdiff_t count = std::count_if (points.begin (), points.end (), on_face);
  return static_cast<double> (count) > cuboid_share * static_cast<double> (points.size ());
}

PrismWalls::PrismWalls (const std::vector<OrientedPoint>& points, const std::vector<OrientedPoint>& copies,
                        const std::vector<Eigen::Vector3d>& faces, const Eigen::Vector4d& plane)
    : plane_ (plane)
{
  const Eigen::Vector3d up = plane.head<3> ();
  const auto is_vertical = [&] (const Eigen::Vector3d& n) { return std::abs (n.dot (up)) < wall_rise; };
  const auto largest_end = faces.begin () + static_cast<std::ptrdiff_t> (std::min (few_faces, faces.size ()));
  const auto largest_wall = std::find_if (faces.begin (), largest_end, is_vertical);
  if (largest_wall == largest_end || !std::all_of (faces.begin (), largest_end, [&] (const Eigen::Vector3d& n) {
        return is_vertical (n) || std::abs (n.dot (up)) > level;
      }))
    return;
  axes_.col (2) = up;
  axes_.col (1) = up.cross (*largest_wall).normalized ();
  axes_.col (0) = axes_.col (1).cross (up);

  const auto placesOf = [&] (const std::vector<OrientedPoint>& all) {
    std::vector<Eigen::Vector2d> places;
    for (const OrientedPoint& p : all)
      places.emplace_back ((axes_.leftCols<2> ().transpose () * p.position.cast<double> ()));
    return places;
  };
  const std::vector<Eigen::Vector2d> seen = placesOf (points), expected = placesOf (copies);
  std::vector<Eigen::Vector2d> face_normals;
  // By which noise widens the outline at faces; other directions have corners in front of them.
  double face_margin = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3d& face : faces)
  {
    if (!is_vertical (face))
      continue;
    const Eigen::Vector2d n = (axes_.leftCols<2> ().transpose () * face).normalized ();
    std::vector<double> offsets;
    for (std::size_t p = 0; p < points.size (); ++p)
      if (face.dot (points[p].normal.cast<double> ()) > face_cosine)
        offsets.push_back (n.dot (seen[p]));
    if (offsets.empty ())
      continue;
    face_normals.push_back (n);
    face_margin = std::min (face_margin, reach (seen, n) - quantile (offsets, 0.5));
  }
  if (face_normals.empty ())
    return;
  const auto marginOf = [&] (const Eigen::Vector2d& n) {
    const auto faces_it = [&] (const Eigen::Vector2d& normal) { return normal.dot (n) > face_cosine; };
    return std::any_of (face_normals.begin (), face_normals.end (), faces_it) ? face_margin : 0.0;
  };

  std::vector<double> heights;
  for (const OrientedPoint& p : points)
  {
    heights.push_back (up.dot (p.position.cast<double> ()) + plane[3]);
    if (p.normal.cast<double> ().dot (up) > level)
      top_.push_back (axes_.transpose () * p.position.cast<double> ());
  }
  shows_top_ = !top_.empty () && static_cast<double> (top_.size ()) >= least_top * static_cast<double> (points.size ());
  for (int d = 0; d < outline_directions; ++d)
  {
    const double angle = 2.0 * M_PI * d / outline_directions;
    const Eigen::Vector2d n (std::cos (angle), std::sin (angle));
    const double offset = std::max (reach (seen, n) - marginOf (n), reach (expected, n) - marginOf (-n));
    const double width = reach (seen, n) + reach (seen, -n);
    std::vector<double> near;
    for (std::size_t p = 0; p < points.size (); ++p)
      if (n.dot (seen[p]) > offset - near_wall * width)
        near.push_back (heights[p]);
    if (near.empty ())
      near = heights;
    walls_.push_back ({n, offset, quantile (near, 1.0 - top_outliers)});
  }
}

std::vector<WallColumn>
PrismWalls::columns (double step_m) const
{
  std::vector<WallColumn> columns;
  for (const Wall& wall : walls_)
  {
    const Eigen::Vector2d along (-wall.normal.y (), wall.normal.x ());
    double first = -std::numeric_limits<double>::infinity (), last = -first; // within the outline
    for (const Wall& other : walls_)
    {
      const double left = other.offset - wall.offset * other.normal.dot (wall.normal), rise = other.normal.dot (along);
      if (std::abs (rise) < parallel)
        continue;
      (rise > 0.0 ? last : first) = rise > 0.0 ? std::min (last, left / rise) : std::max (first, left / rise);
    }
    for (double t = first + 0.5 * step_m; t < last; t += step_m)
      columns.push_back (column (wall.offset * wall.normal + t * along, wall.normal, 0.0, wall.top, step_m));
  }
  return columns;
}

WallColumn
PrismWalls::column (const Eigen::Vector2d& place, const Eigen::Vector2d& normal, double bottom, double top,
                    double step_m) const
{
  WallColumn column;
  const Eigen::Vector3f outwards = (axes_.leftCols<2> () * normal).cast<float> ();
  for (double height = bottom + 0.5 * step_m; height < top; height += step_m)
    column.push_back (
        {(axes_ * Eigen::Vector3d (place.x (), place.y (), height - plane_[3])).cast<float> (), outwards});
  return column;
}

std::optional<double>
PrismWalls::levelTop () const
{
  std::vector<double> along;
  for (const Eigen::Vector3d& p : top_)
    along.push_back (p.z ());
  const double middle = quantile (along, 0.5), low = quantile (along, lowest_top);
  return middle - low < level_rise * (middle + plane_[3]) ? std::optional<double> (middle) : std::nullopt;
}

std::vector<WallColumn>
PrismWalls::belowEdges (double step_m) const
{
  // Cells of the top, and how high it is there.
  using Cell = std::pair<int, int>;
  std::map<Cell, std::vector<double>> seen;
  const Eigen::Vector2d first = top_.front ().head<2> ();
  for (const Eigen::Vector3d& p : top_)
  {
    const Eigen::Array2d cell = ((p.head<2> () - first).array () / step_m).floor ();
    seen[{static_cast<int> (cell.x ()), static_cast<int> (cell.y ())}].push_back (p.z () + plane_[3]);
  }
  std::map<Cell, double> heights;
  for (auto& [cell, values] : seen)
    heights[cell] = quantile (values, 0.5);
  const auto around = [&] (const Cell& cell, int reach, auto&& f) {
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        if (const auto other = heights.find ({cell.first + i, cell.second + j}); other != heights.end ())
          f (Eigen::Vector2d (i, j), other->second);
  };
  std::vector<WallColumn> columns;
  for (const auto& [cell, top] : heights)
  {
    // Where the top ends, most cells nearby are on one side.
    const double height = top;
    Eigen::Vector2d side = Eigen::Vector2d::Zero ();
    std::size_t near = 0;
    around (cell, edge_cells, [&] (const Eigen::Vector2d& to, double other) {
      if (std::abs (other - height) > edge_cells * step_m)
        return;
      side += to;
      ++near;
    });
    if (near < least_near || side.norm () < least_side * static_cast<double> (near))
      continue;
    const Eigen::Vector2d out = -side.normalized ();
    bool goes_on = false;
    double bottom = 0.0; // of the wall: a lower top beside it, if there is one
    around (cell, edge_cells, [&] (const Eigen::Vector2d& to, double other) {
      if (to.dot (out) < 0.9)
        return;
      if (other > height - edge_cells * step_m)
        goes_on |= std::abs (to.x () * out.y () - to.y () * out.x ()) < 1.0;
      else
        bottom = std::max (bottom, other);
    });
    if (!goes_on)
      columns.push_back (column (first + step_m * (Eigen::Vector2d (cell.first + 0.5, cell.second + 0.5) + 0.5 * out),
                                 out, bottom, height, step_m));
  }
  return columns;
}

} // namespace pcl::cosection
