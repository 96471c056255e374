// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "contact_edge.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"
#include "pcl_cosection/common/sectors.h"
#include "pcl_cosection/common/sphere_directions.h"
#include "pcl_cosection/priors/shape/normal_axis.h"

#include "pcl_cosection/view/visibility/visibility.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

namespace pcl::cosection {
namespace {

// "Of the size" is relative to NormalLines::size.
constexpr double cell_size = 0.06; // of the size
constexpr double largest_cell = 0.16;
constexpr double cell_growth = 1.3;
constexpr double points_per_cell = 2.0;              // with more, an empty cell is a hole and no gap between points
constexpr double neighbour_reach = 2.3;              // cells
constexpr std::size_t least_neighbours = 4;          // a cell with fewer is an outlier
constexpr double open_angle = 2.3;                   // radians: a gap in the neighbours that makes a border cell
constexpr std::array<double, 2> beyond = {1.0, 1.6}; // distances at which the surface would continue, cells
constexpr double least_facing = 0.4;                 // cosine at which a sensor sees a surface well
constexpr double flat_ridge = 0.5;                   // cells squared: damps curvature fitted to few neighbours
constexpr int directions = 800;
constexpr double outlier_share = 0.01; // of the points, may lie behind the plane
constexpr double rough_reach = 0.12;   // of the size
constexpr double reach = 1.2;          // cells, from the plane to the centre of a cell that touches it
constexpr int rounds = 8;
constexpr int fit_rounds = 6;      // of reweighting
constexpr double fit_scale = 0.02; // of the size: a distance from the plane with half weight
constexpr std::size_t least_cells = 6;
constexpr double least_spread = 0.1; // of the size, in both directions along the plane
constexpr int sectors = 36;
constexpr int least_sectors = 9;
constexpr double other_sectors = 0.2;   // of those: largest share in which the surface ends elsewhere
constexpr double silhouette_rise = 0.8; // height of all sensors over the plane, of their distances
constexpr double least_height = 0.15;   // of the size: a flatter plane may be a face of the object
constexpr double level = 0.7;           // component of a normal upwards: such a surface may end at a sharp edge
constexpr double facing_down = -0.5;
constexpr double down_share = 0.02; // of all points: a standing object shows no more from below
// Least height of a sensor over the plane, of its distance: an edge that hides the object may make a plane through it.
constexpr double least_rise = 0.15;

struct Demand // on contact
{
  double roughness; // upper limit of the root mean square distance of the ends from the plane, of the size
  double facing;    // lower limit of the mean facing
};

constexpr Demand of_one_sensor = {0.028, 0.53};
constexpr Demand of_several = {0.04, 0.5}; // silhouettes of several sensors lie on no common plane
constexpr Demand of_silhouettes = {0.028, 0.7};

using Views = OcclusionMap::Views;

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
cellsOf (const std::vector<NormalLine>& lines, double edge)
{
  std::map<std::tuple<int, int, int>, Cell> cells;
  for (const NormalLine& line : lines)
  {
    const Eigen::Vector3i at = (line.position / edge).array ().floor ().cast<int> ();
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
wayOut (const Cell& cell, const std::vector<Cell>& cells, double radius)
{
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
  if (!(gap > open_angle))
    return std::nullopt;
  return Eigen::Vector3d (std::cos (middle) * x + std::sin (middle) * y);
}

struct Plane
{
  Eigen::Vector3d up;
  double height;
};

class ContactSearch
{
public:
  ContactSearch (const NormalLines& normals, const Views& views) : lines_ (normals.lines)
  {
    for (const auto& [view, T_object_sensor] : views)
      sensors_.push_back ((T_object_sensor.translation () - normals.origin) / normals.size);
    for (edge_ = cell_size; edge_ < largest_cell; edge_ *= cell_growth)
    {
      cells_ = cellsOf (lines_, edge_);
      if (points_per_cell * static_cast<double> (cells_.size ()) < static_cast<double> (lines_.size ()))
        break;
      cells_.clear ();
    }
    for (Cell& cell : cells_)
      if (const auto out = wayOut (cell, cells_, neighbour_reach * edge_))
        for (std::size_t v = 0; v < views.size (); ++v)
        {
          const auto at = [&] (double cells) {
            return Eigen::Vector3d (normals.origin + normals.size * (cell.position + cells * edge_ * *out));
          };
          const auto goes_on = [&] (double cells) { return isOpen (at (cells), normals.size * edge_, views[v]); };
          const double cosine = facingBeyond (cell, *out, sensors_[v]);
          if (cosine > std::max (least_facing, cell.facing) && std::all_of (beyond.begin (), beyond.end (), goes_on) &&
              !isSeen (at (beyond.back ()), normals.size * edge_, views[v]))
            cell.facing = cosine;
        }
  }

  std::optional<Plane> plane () const
  {
    std::optional<Plane> plane = roughPlane ();
    for (int r = 0; r < rounds && plane; ++r)
      plane = through (endsNear (*plane, r < rounds / 2 ? rough_reach : reach * edge_), *plane);
    if (!plane || !isContact (*plane))
      return std::nullopt;
    return plane;
  }

private:
  /** \brief Cosine between the normal and the direction to a sensor, one cell farther out, if the surface continues
   * with its curvature. At silhouettes the surface bends away. */
  double facingBeyond (const Cell& cell, const Eigen::Vector3d& out, const Eigen::Vector3d& sensor) const
  {
    const double radius = neighbour_reach * edge_;
    Eigen::Matrix2d left = Eigen::Matrix2d::Zero ();
    Eigen::Vector2d right = Eigen::Vector2d::Zero ();
    for (const Cell& other : cells_)
      if (const Eigen::Vector3d q = other.position - cell.position; q.squaredNorm () < radius * radius)
      {
        const Eigen::Vector2d row (1.0, out.dot (q) / edge_);
        left += row * row.transpose ();
        right += other.normal.dot ((sensor - other.position).normalized ()) * row;
      }
    left (1, 1) += flat_ridge;
    return left.ldlt ().solve (right).sum ();
  }

  /** \brief Whether a view would see a surface at a place: no reading lies in front of it by more than depth_m. */
  static bool isOpen (const Eigen::Vector3d& p, double depth_m, const Views::value_type& view)
  {
    const PointVisibility visibility = visibilityOf (view.second.inverse () * p, *view.first, depth_m);
    return visibility != PointVisibility::Outside && visibility != PointVisibility::Occluded;
  }

  /** \brief Whether a view has a reading just there. Without a reliable normal it is no point, but the surface does not
   * end in front of it. */
  static bool isSeen (const Eigen::Vector3d& p, double depth_m, const Views::value_type& view)
  {
    return visibilityOf (view.second.inverse () * p, *view.first, depth_m) == PointVisibility::AtSurface;
  }

  /** \brief Whether all sensors are above a plane. An edge that hides the object may make a plane through a sensor. */
  bool isSeenFromAbove (const Plane& plane) const
  {
    return std::all_of (sensors_.begin (), sensors_.end (), [&] (const Eigen::Vector3d& sensor) {
      return plane.up.dot (sensor) - plane.height > least_rise * sensor.norm ();
    });
  }

  /** \brief Whether the plane faces all sensors, as the plane of a silhouette does. */
  bool mayBeSilhouette (const Plane& plane) const
  {
    return std::all_of (sensors_.begin (), sensors_.end (), [&] (const Eigen::Vector3d& sensor) {
      return plane.up.dot (sensor) - plane.height > silhouette_rise * sensor.norm ();
    });
  }

  /** \brief The quantile of the points' heights along \a up. */
  double heightAlong (const Eigen::Vector3d& up, double share) const
  {
    std::vector<double> heights;
    heights.reserve (lines_.size ());
    for (const NormalLine& line : lines_)
      heights.push_back (up.dot (line.position));
    return quantile (heights, share);
  }

  /** \brief Whether the end of a cell counts: a horizontal surface may end at a sharp edge. */
  static bool mayEnd (const Cell& cell, const Plane& plane)
  {
    return cell.facing > 0.0 && plane.up.dot (cell.normal) < level;
  }

  std::vector<const Cell*> endsNear (const Plane& plane, double distance) const
  {
    std::vector<const Cell*> near;
    for (const Cell& cell : cells_)
      if (mayEnd (cell, plane) && plane.up.dot (cell.position) - plane.height < distance)
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
      const std::size_t count = isSeenFromAbove (plane) ? endsNear (plane, rough_reach).size () : 0;
      if (count > most)
      {
        most = count;
        best = plane;
      }
    }
    return best;
  }

  /** \brief The plane nearest to the lowest points of some cells, if it is below all points. */
  std::optional<Plane> through (const std::vector<const Cell*>& cells, const Plane& before) const
  {
    if (cells.size () < least_cells)
      return std::nullopt;
    std::vector<Eigen::Vector3d> ends;
    for (const Cell* cell : cells)
      ends.push_back (cell->lowest (before.up));
    std::vector<double> weights (ends.size (), 1.0);
    Plane plane = before;
    for (int r = 0; r < fit_rounds; ++r)
    {
      const double all = std::accumulate (weights.begin (), weights.end (), 0.0);
      Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
      for (std::size_t n = 0; n < ends.size (); ++n)
        middle += weights[n] / all * ends[n];
      Eigen::Matrix3d spread = Eigen::Matrix3d::Zero ();
      for (std::size_t n = 0; n < ends.size (); ++n)
        spread += weights[n] / all * (ends[n] - middle) * (ends[n] - middle).transpose ();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (spread);
      if (!(solver.eigenvalues ()[1] > least_spread * least_spread))
        return std::nullopt;
      const Eigen::Vector3d normal = solver.eigenvectors ().col (0);
      plane.up = normal.dot (before.up) < 0.0 ? Eigen::Vector3d (-normal) : normal;
      for (std::size_t n = 0; n < ends.size (); ++n)
        weights[n] = cauchyWeight (plane.up.dot (ends[n] - middle) / fit_scale);
    }
    plane.height = heightAlong (plane.up, outlier_share);
    return plane;
  }

  bool isContact (const Plane& plane) const
  {
    if (!isSeenFromAbove (plane) || heightAlong (plane.up, 1.0 - outlier_share) - plane.height < least_height)
      return false;
    const auto down = std::count_if (lines_.begin (), lines_.end (),
                                     [&] (const NormalLine& line) { return plane.up.dot (line.normal) < facing_down; });
    if (static_cast<double> (down) > down_share * static_cast<double> (lines_.size ()))
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
      if (plane.up.dot (cell->position) - plane.height < reach * edge_)
      {
        ++touching;
        cosines += cell->facing;
        squares += std::pow (plane.up.dot (cell->lowest (plane.up)) - plane.height, 2);
      }
      else
        ++other;
    }
    const Demand& demand = mayBeSilhouette (plane) ? of_silhouettes : sensors_.size () > 1 ? of_several : of_one_sensor;
    return touching >= least_sectors && other <= other_sectors * touching &&
           squares < demand.roughness * demand.roughness * touching && cosines > demand.facing * touching;
  }

  const std::vector<NormalLine>& lines_;
  std::vector<Eigen::Vector3d> sensors_;
  double edge_ = 0.0;
  std::vector<Cell> cells_;
};

} // namespace

std::optional<Eigen::Vector4d>
contactBoundaryPlane (const std::vector<OrientedPoint>& points, const Views& views)
{
  const NormalLines normals = normalLinesOf (points);
  if (views.empty () || normals.lines.empty () || !(normals.size > 0.0))
    return std::nullopt;
  const std::optional<Plane> plane = ContactSearch (normals, views).plane ();
  if (!plane)
    return std::nullopt;
  Eigen::Vector4d world;
  world << plane->up, -(normals.size * plane->height + plane->up.dot (normals.origin));
  return world;
}

} // namespace pcl::cosection
