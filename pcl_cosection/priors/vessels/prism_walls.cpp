// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "prism_walls.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double vertical = 0.17;     // largest component of a wall's normal upwards
constexpr double level = 0.97;        // least component of a top's normal upwards
constexpr std::size_t few_faces = 3;  // the largest
constexpr double face_cosine = 0.966; // 15 degrees
constexpr int directions = 72;        // of the outline
constexpr double outliers = 0.002;    // of the points: those that may lie beyond the outline
constexpr double near_wall = 0.15;    // of the width across a wall: points so near show its height
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

PrismWalls::PrismWalls (const std::vector<OrientedPoint>& points, const std::vector<OrientedPoint>& copies,
                        const std::vector<Eigen::Vector3d>& faces, const Eigen::Vector4d& plane)
    : plane_ (plane)
{
  const Eigen::Vector3d up = plane.head<3> ();
  const auto is_vertical = [&] (const Eigen::Vector3d& n) { return std::abs (n.dot (up)) < vertical; };
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
  struct Face
  {
    Eigen::Vector2d normal;
    double margin; // by which noise widens the outline
  };
  std::vector<Face> vertical_faces;
  for (const Eigen::Vector3d& face : faces)
  {
    if (!is_vertical (face))
      continue;
    const Eigen::Vector2d n = (axes_.leftCols<2> ().transpose () * face).normalized ();
    std::vector<double> offsets;
    for (std::size_t p = 0; p < points.size (); ++p)
      if (face.dot (points[p].normal.cast<double> ()) > face_cosine)
        offsets.push_back (n.dot (seen[p]));
    if (!offsets.empty ())
      vertical_faces.push_back ({n, reach (seen, n) - quantile (offsets, 0.5)});
  }
  if (vertical_faces.empty ())
    return;
  const double margin = std::min_element (vertical_faces.begin (), vertical_faces.end (),
                                          [] (const Face& a, const Face& b) { return a.margin < b.margin; })
                            ->margin; // other directions have corners in front of them
  const auto marginOf = [&] (const Eigen::Vector2d& n) {
    const auto faces_it = [&] (const Face& face) { return face.normal.dot (n) > face_cosine; };
    return std::any_of (vertical_faces.begin (), vertical_faces.end (), faces_it) ? margin : 0.0;
  };

  points_ = points.size ();
  for (const OrientedPoint& p : points)
    if (p.normal.cast<double> ().dot (up) > level)
      top_.push_back (axes_.transpose () * p.position.cast<double> ());
  std::vector<double> heights;
  for (const OrientedPoint& p : points)
    heights.push_back (up.dot (p.position.cast<double> ()) + plane[3]);
  for (int d = 0; d < directions; ++d)
  {
    const double angle = 2.0 * M_PI * d / directions;
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

bool
PrismWalls::showsTop () const
{
  return !top_.empty () && static_cast<double> (top_.size ()) >= least_top * static_cast<double> (points_);
}

std::optional<double>
PrismWalls::levelTop () const
{
  if (!showsTop ())
    return std::nullopt;
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
  if (top_.empty ())
    return {};
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
