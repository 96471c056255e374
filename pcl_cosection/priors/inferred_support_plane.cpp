// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "inferred_support_plane.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>

namespace pcl::cosection {
namespace {

// "Of the size" is relative to NormalLines::size.
constexpr int sectors = 36;                 // around the middle
constexpr double outlier_share = 0.01;      // of all points: those that may lie below the plane
constexpr double cell_size = 0.08;          // of the size
constexpr double points_per_cell = 2.0;     // with fewer, an empty cell may be a gap between points
constexpr double neighbour_reach = 2.3;     // cells
constexpr std::size_t least_neighbours = 4; // a cell with fewer is an outlier
constexpr double open_angle = 2.3;          // radians: a gap in the neighbours that makes a border cell
constexpr double beyond = 1.6;              // distance at which the surface would continue, cells
constexpr double least_facing = 0.4;        // cosine at which a sensor sees a surface well
constexpr double mean_facing = 0.53;        // along the contact
constexpr double flat_ridge = 0.5;          // cells squared: damps curvature fitted to few neighbours
constexpr int directions = 800;
constexpr double rough_reach = 2.0; // cells, from a first guess of the plane
constexpr double reach = 1.2;       // cells, from the plane to the centre of a cell that touches it
constexpr int rounds = 8;
constexpr int least_sectors = 9;
constexpr double other_share = 0.2;   // of those: largest share in which the surface ends elsewhere
constexpr double roughness = 0.5;     // cells: largest root mean square distance of the ends from the plane
constexpr double least_height = 0.15; // of the size: a flatter plane may be a face of the object
constexpr double edge_level = 0.7;    // component of a normal upwards: such a surface may end at a sharp edge
constexpr double underside = -0.5;    // component of a normal upwards: a standing object shows no such points
// Least height of a sensor over the plane, of its distance: an edge that hides the object may make a plane through it.
constexpr double least_rise = 0.15;

/** \brief A plane in the frame of NormalLines. */
struct Plane
{
  Eigen::Vector3d up;
  double height;
};

Eigen::Vector4d
inMetres (const Plane& plane, const NormalLines& normals)
{
  Eigen::Vector4d metres;
  metres << plane.up, -(normals.size * plane.height + plane.up.dot (normals.origin));
  return metres;
}

/** \brief The quantile of the points' heights along \a up. */
double
heightAlong (const Eigen::Vector3d& up, const std::vector<NormalLine>& lines, double share)
{
  std::vector<double> heights;
  for (const NormalLine& line : lines)
    heights.push_back (up.dot (line.position));
  return quantile (heights, share);
}

struct Cell
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero ();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero ();
  std::vector<Eigen::Vector3d> points;
  double facing = 0.0; // cosine to the sensor that would see the continued surface best; 0: no end here

  Eigen::Vector3d lowest (const Eigen::Vector3d& up) const
  {
    return *std::min_element (points.begin (), points.end (),
                              [&] (const auto& a, const auto& b) { return up.dot (a) < up.dot (b); });
  }
};

std::vector<Cell>
cellsOf (const std::vector<NormalLine>& lines)
{
  std::map<std::tuple<int, int, int>, Cell> cells;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3i at = (line.position / cell_size).array ().floor ().cast<int> ();
    Cell& cell = cells[{at.x (), at.y (), at.z ()}];
    cell.position += line.position;
    cell.normal += line.normal;
    cell.points.push_back (line.position);
  }
  std::vector<Cell> list;
  for (auto& [at, cell] : cells)
    if (cell.normal.norm () > 0.0)
    {
      cell.position /= static_cast<double> (cell.points.size ());
      cell.normal.normalize ();
      list.push_back (cell);
    }
  return list;
}

/** \brief The middle of the largest gap between the directions of a cell's neighbours along the surface; nothing if
 * there is no large gap. */
std::optional<Eigen::Vector3d>
wayOut (const Cell& cell, const std::vector<Cell>& cells)
{
  const double radius = neighbour_reach * cell_size;
  const Eigen::Vector3d x = cell.normal.unitOrthogonal ();
  const Eigen::Vector3d y = cell.normal.cross (x);
  std::vector<double> turns;
  for (const Cell& other : cells)
    if (const Eigen::Vector3d q = other.position - cell.position; &other != &cell && q.squaredNorm () < radius * radius)
      turns.push_back (std::atan2 (y.dot (q), x.dot (q)));
  if (turns.size () < least_neighbours)
    return std::nullopt;
  std::sort (turns.begin (), turns.end ());
  double gap = 0.0, middle = 0.0;
  for (std::size_t n = 0; n < turns.size (); ++n)
    if (const double next = n + 1 < turns.size () ? turns[n + 1] : turns[0] + 2.0 * M_PI; next - turns[n] > gap)
    {
      gap = next - turns[n];
      middle = turns[n] + 0.5 * gap;
    }
  const Eigen::Vector3d out = std::cos (middle) * x + std::sin (middle) * y;
  return gap > open_angle ? std::optional<Eigen::Vector3d> (out) : std::nullopt;
}

class ContactSearch
{
public:
  ContactSearch (const NormalLines& normals, const OcclusionMap::Views& views) : lines_ (normals.lines)
  {
    for (const auto& [view, T_object_sensor] : views)
      sensors_.push_back ((T_object_sensor.translation () - normals.origin) / normals.size);
    cells_ = cellsOf (lines_);
    if (points_per_cell * static_cast<double> (cells_.size ()) > static_cast<double> (lines_.size ()))
      cells_.clear ();
    for (Cell& cell : cells_)
      if (const auto out = wayOut (cell, cells_))
        for (std::size_t v = 0; v < views.size (); ++v)
        {
          const Eigen::Vector3d p = normals.origin + normals.size * (cell.position + beyond * cell_size * *out);
          const PointVisibility there = visibilityOf (views[v].second.inverse () * p, *views[v].first,
                                                      normals.size * cell_size);
          const double cosine = facingBeyond (cell, *out, sensors_[v]);
          // A reading just there without a reliable normal is no point, but the surface does not end in front of it.
          if (cosine > std::max (least_facing, cell.facing) && there != PointVisibility::Outside &&
              there != PointVisibility::Occluded && there != PointVisibility::AtSurface)
            cell.facing = cosine;
        }
  }

  std::optional<Plane> plane () const
  {
    std::optional<Plane> plane = roughPlane ();
    for (int r = 0; r < rounds && plane; ++r)
      plane = through (endsNear (*plane, r < rounds / 2 ? rough_reach : reach), *plane);
    return plane && isContact (*plane) ? plane : std::nullopt;
  }

private:
  /** \brief Cosine between the normal and the direction to a sensor, one cell farther out, if the surface continues
   * with its curvature. At silhouettes the surface bends away. */
  double facingBeyond (const Cell& cell, const Eigen::Vector3d& out, const Eigen::Vector3d& sensor) const
  {
    const double radius = neighbour_reach * cell_size;
    Eigen::Matrix2d left = Eigen::Matrix2d::Zero ();
    Eigen::Vector2d right = Eigen::Vector2d::Zero ();
    for (const Cell& other : cells_)
      if (const Eigen::Vector3d q = other.position - cell.position; q.squaredNorm () < radius * radius)
      {
        const Eigen::Vector2d row (1.0, out.dot (q) / cell_size);
        left += row * row.transpose ();
        right += other.normal.dot ((sensor - other.position).normalized ()) * row;
      }
    left (1, 1) += flat_ridge;
    return left.ldlt ().solve (right).sum ();
  }

  bool isSeenFromAbove (const Plane& plane) const
  {
    return std::all_of (sensors_.begin (), sensors_.end (), [&] (const Eigen::Vector3d& sensor) {
      return plane.up.dot (sensor) - plane.height > least_rise * sensor.norm ();
    });
  }

  /** \brief Whether the end of a cell counts: a horizontal surface may end at a sharp edge. */
  static bool mayEnd (const Cell& cell, const Plane& plane)
  {
    return cell.facing > 0.0 && plane.up.dot (cell.normal) < edge_level;
  }

  std::vector<const Cell*> endsNear (const Plane& plane, double distance) const
  {
    std::vector<const Cell*> near;
    for (const Cell& cell : cells_)
      if (mayEnd (cell, plane) && plane.up.dot (cell.position) - plane.height < distance * cell_size)
        near.push_back (&cell);
    return near;
  }

  std::optional<Plane> roughPlane () const
  {
    std::optional<Plane> best;
    std::size_t most = 0;
    for (int n = 0; n < directions; ++n)
    {
      const Eigen::Vector3d up = sphereDirection (n, directions).cast<double> ();
      double lowest = std::numeric_limits<double>::infinity ();
      for (const Cell& cell : cells_)
        lowest = std::min (lowest, up.dot (cell.position));
      const Plane plane{up, lowest};
      if (!isSeenFromAbove (plane))
        continue;
      if (const std::size_t count = endsNear (plane, rough_reach).size (); count > most)
      {
        most = count;
        best = plane;
      }
    }
    return best;
  }

  /** \brief The plane along the lowest points of some cells, below all points. */
  std::optional<Plane> through (const std::vector<const Cell*>& cells, const Plane& before) const
  {
    if (cells.size () < least_sectors)
      return std::nullopt;
    std::vector<Eigen::Vector3d> ends;
    for (const Cell* cell : cells)
      ends.push_back (cell->lowest (before.up));
    const Eigen::Vector3d up = planeNormal (ends, before.up);
    return Plane{up, heightAlong (up, lines_, outlier_share)};
  }

  bool isContact (const Plane& plane) const
  {
    const auto under = std::count_if (lines_.begin (), lines_.end (),
                                      [&] (const NormalLine& line) { return plane.up.dot (line.normal) < underside; });
    if (!isSeenFromAbove (plane) || heightAlong (plane.up, lines_, 1.0 - outlier_share) - plane.height < least_height ||
        static_cast<double> (under) > outlier_share * static_cast<double> (lines_.size ()))
      return false;
    const Sectors around (plane.up, sectors);
    std::array<const Cell*, sectors> lowest{};
    for (const Cell& cell : cells_)
    {
      const Cell*& of_sector = lowest[around.of (cell.position)];
      if (!of_sector || plane.up.dot (cell.position) < plane.up.dot (of_sector->position))
        of_sector = &cell;
    }
    int touching = 0, other = 0;
    double cosines = 0.0, squares = 0.0;
    for (const Cell* cell : lowest)
    {
      if (!cell || !mayEnd (*cell, plane))
        continue;
      if (plane.up.dot (cell->position) - plane.height < reach * cell_size)
      {
        ++touching;
        cosines += cell->facing;
        squares += std::pow (plane.up.dot (cell->lowest (plane.up)) - plane.height, 2);
      }
      else
        ++other;
    }
    return touching >= least_sectors && other <= other_share * touching &&
           squares < roughness * roughness * cell_size * cell_size * touching && cosines > mean_facing * touching;
  }

  const std::vector<NormalLine>& lines_;
  std::vector<Eigen::Vector3d> sensors_;
  std::vector<Cell> cells_;
};

} // namespace

std::optional<Eigen::Vector4d>
contactBoundaryPlane (const std::vector<OrientedPoint>& points, const OcclusionMap::Views& views)
{
  const NormalLines normals = normalLinesOf (points);
  if (views.empty () || normals.lines.empty () || !(normals.size > 0.0))
    return std::nullopt;
  const std::optional<Plane> plane = ContactSearch (normals, views).plane ();
  return plane ? std::optional<Eigen::Vector4d> (inMetres (*plane, normals)) : std::nullopt;
}

} // namespace pcl::cosection
