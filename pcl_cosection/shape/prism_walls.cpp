// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "prism_walls.h"

#include "../common/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double upright = 0.17;      // component of the normal of a wall along the axis, at most
constexpr double level = 0.97;        // that of a top, at least
constexpr std::size_t few_faces = 3;  // the largest
constexpr double face_cosine = 0.966; // 15 degrees
constexpr int directions = 72;        // of the outline
constexpr double strays = 0.002;      // of the points, may lie beyond the outline
constexpr double near_wall = 0.15;    // of the width across it: what is so near tells how high it is
constexpr double top_strays = 0.02;
constexpr double parallel = 1e-9;     // sine between walls

/** \brief The largest component along a direction, but for strays. */
double
reach (const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& direction)
{
  if (places.empty ())
    return -std::numeric_limits<double>::infinity ();
  std::vector<double> along;
  along.reserve (places.size ());
  for (const Eigen::Vector2d& p : places)
    along.push_back (direction.dot (p));
  return quantile (along, 1.0 - strays);
}

} // namespace

PrismWalls::PrismWalls (const std::vector<OrientedPoint>& points, const std::vector<OrientedPoint>& copies, const std::vector<Eigen::Vector3d>& faces,
                        const Eigen::Vector4d& plane)
: plane_ (plane)
{
  const Eigen::Vector3d up = plane.head<3> ();
  const auto is_upright = [&] (const Eigen::Vector3d& n) { return std::abs (n.dot (up)) < upright; };
  const auto largest_end = faces.begin () + static_cast<std::ptrdiff_t> (std::min (few_faces, faces.size ()));
  const auto largest_wall = std::find_if (faces.begin (), largest_end, is_upright);
  if (largest_wall == largest_end ||
      !std::all_of (faces.begin (), largest_end, [&] (const Eigen::Vector3d& n) { return is_upright (n) || std::abs (n.dot (up)) > level; }))
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
    double margin; // by which noise widens the outline there
  };
  std::vector<Face> upright_faces;
  for (const Eigen::Vector3d& face : faces)
  {
    if (!is_upright (face))
      continue;
    const Eigen::Vector2d n = (axes_.leftCols<2> ().transpose () * face).normalized ();
    std::vector<double> offsets;
    for (std::size_t p = 0; p < points.size (); ++p)
      if (face.dot (points[p].normal.cast<double> ()) > face_cosine)
        offsets.push_back (n.dot (seen[p]));
    if (!offsets.empty ())
      upright_faces.push_back ({n, reach (seen, n) - quantile (offsets, 0.5)});
  }
  if (upright_faces.empty ())
    return;
  const double margin = std::min_element (upright_faces.begin (), upright_faces.end (), [] (const Face& a, const Face& b) {
                          return a.margin < b.margin;
                        })->margin; // others have corners before them
  const auto marginOf = [&] (const Eigen::Vector2d& n) {
    const auto faces_it = [&] (const Face& face) { return face.normal.dot (n) > face_cosine; };
    return std::any_of (upright_faces.begin (), upright_faces.end (), faces_it) ? margin : 0.0;
  };

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
    std::vector<double>& those = near.empty () ? heights : near;
    walls_.push_back ({n, offset, quantile (those, 1.0 - top_strays)});
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
    const Eigen::Vector3d normal = axes_.leftCols<2> () * wall.normal;
    for (double t = first + 0.5 * step_m; t < last; t += step_m)
    {
      const Eigen::Vector2d place = wall.offset * wall.normal + t * along;
      columns.emplace_back ();
      for (double height = 0.5 * step_m; height < wall.top; height += step_m)
        columns.back ().push_back ({(axes_ * Eigen::Vector3d (place.x (), place.y (), height - plane_[3])).cast<float> (), normal.cast<float> ()});
    }
  }
  return columns;
}

} // namespace cosection
} // namespace pcl
