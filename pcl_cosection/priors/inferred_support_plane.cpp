// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "inferred_support_plane.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/shape/footprint_axis.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace pcl::cosection {
namespace {

// "Of the size" is relative to NormalLines::size.
constexpr int sectors = 36;            // around the middle
constexpr double outlier_share = 0.01; // of all points: those that may lie below the plane

// An open thing.
constexpr std::size_t least_points = 50;
constexpr double usual_wall = 0.04;  // of the radius
constexpr double lid_rise = 0.12;    // of the radius: a thing with a lower border may be a lid
constexpr double facing_down = -0.3; // component of a normal upwards
constexpr double down_share = 0.05;  // of all points: an open thing shows no more that face down
constexpr double floor_level = 0.9;  // component of a floor's normal upwards
constexpr double floor_radius = 0.5; // of the radius: points of the floor are nearer to the middle
constexpr std::size_t least_floor = 10;
constexpr double rim_radius = 0.8;   // of the farthest point in a sector: points farther out are near the rim
constexpr double rim_outliers = 0.1; // of those: points that may be higher than the rim
constexpr int higher_sectors = 27;   // least number with a rim higher than the floor

// The contact boundary.
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
constexpr double rough_reach = 0.12; // of the size
constexpr double reach = 1.2;        // cells, from the plane to the centre of a cell that touches it
constexpr int rounds = 8;
constexpr int fit_rounds = 6;      // of reweighting
constexpr double fit_scale = 0.02; // of the size: a distance from the plane with half weight
constexpr std::size_t least_cells = 6;
constexpr double least_spread = 0.1; // of the size, in both directions along the plane
constexpr int least_sectors = 9;
constexpr double other_sectors = 0.2;    // of those: largest share in which the surface ends elsewhere
constexpr double silhouette_rise = 0.8;  // height of all sensors over the plane, of their distances
constexpr double least_height = 0.15;    // of the size: a flatter plane may be a face of the object
constexpr double edge_level = 0.7;       // component of a normal upwards: such a surface may end at a sharp edge
constexpr double underside = -0.5;       // component of a normal upwards
constexpr double underside_share = 0.02; // of all points: a standing object shows no more from below
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

/** \brief Whether more than a share of the normals have an upward component of less than \a facing. */
bool
showsUnderside (const Eigen::Vector3d& up, const std::vector<NormalLine>& lines, double facing, double share)
{
  const auto down = std::count_if (lines.begin (), lines.end (),
                                   [&] (const NormalLine& line) { return up.dot (line.normal) < facing; });
  return static_cast<double> (down) > share * static_cast<double> (lines.size ());
}

/** \brief The points around a vertical axis, by sector. */
class Surroundings
{
public:
  Surroundings (const std::vector<NormalLine>& lines, const Eigen::Vector3d& up) : lines_ (lines), up_ (up)
  {
    const std::vector<std::size_t> rim = outermost (lines, up);
    for (const std::size_t n : rim)
      center_ += lines[n].position / static_cast<double> (rim.size ());
    for (const std::size_t n : rim)
      radius_ += radiusOf (lines[n].position) / static_cast<double> (rim.size ());
  }

  double radius () const { return radius_; }

  /** \brief Points with vertical normals in the middle. */
  std::vector<Eigen::Vector3d> floor () const
  {
    std::vector<Eigen::Vector3d> floor;
    for (const NormalLine& line : lines_)
      if (up_.dot (line.normal) > floor_level && radiusOf (line.position) < floor_radius * radius_)
        floor.push_back (line.position);
    return floor;
  }

  /** \brief Number of sectors whose rim is higher than \a height. */
  std::ptrdiff_t sectorsHigherThan (double height) const
  {
    const Sectors numbers (up_, sectors);
    std::array<std::vector<Eigen::Vector3d>, sectors> around;
    std::array<double, sectors> reach{};
    for (const NormalLine& line : lines_)
    {
      const std::size_t s = numbers.of (line.position - center_);
      around[s].push_back (line.position);
      reach[s] = std::max (reach[s], radiusOf (line.position));
    }
    std::ptrdiff_t count = 0;
    for (std::size_t s = 0; s < sectors; ++s)
    {
      std::size_t near = 0, higher = 0;
      for (const Eigen::Vector3d& p : around[s])
        if (radiusOf (p) > rim_radius * reach[s])
        {
          ++near;
          higher += up_.dot (p) > height;
        }
      count += near > 0 && static_cast<double> (higher) > rim_outliers * static_cast<double> (near);
    }
    return count;
  }

private:
  double radiusOf (const Eigen::Vector3d& p) const { return up_.cross (p - center_).norm (); }

  const std::vector<NormalLine>& lines_;
  Eigen::Vector3d up_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double radius_ = 0.0; // mean over directions of the largest distance from the axis
};

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
          const auto visibility = [&] (double cells) {
            const Eigen::Vector3d p = normals.origin + normals.size * (cell.position + cells * edge_ * *out);
            return visibilityOf (views[v].second.inverse () * p, *views[v].first, normals.size * edge_);
          };
          // Whether a view would see a surface there: no reading lies in front of it by more than a cell.
          const auto is_open = [&] (double cells) {
            return visibility (cells) != PointVisibility::Outside && visibility (cells) != PointVisibility::Occluded;
          };
          const double cosine = facingBeyond (cell, *out, sensors_[v]);
          // A reading just there without a reliable normal is no point, but the surface does not end in front of it.
          if (cosine > std::max (least_facing, cell.facing) && std::all_of (beyond.begin (), beyond.end (), is_open) &&
              visibility (beyond.back ()) != PointVisibility::AtSurface)
            cell.facing = cosine;
        }
  }

  std::optional<Plane> plane () const
  {
    std::optional<Plane> plane = roughPlane ();
    for (int r = 0; r < rounds && plane; ++r)
      plane = through (endsNear (*plane, r < rounds / 2 ? rough_reach : reach * edge_), *plane);
    return plane && isContact (*plane) ? plane : std::nullopt;
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

  /** \brief Whether all sensors are higher than a plane by more than a share of their distances. */
  bool isSeenFrom (const Plane& plane, double rise) const
  {
    return std::all_of (sensors_.begin (), sensors_.end (), [&] (const Eigen::Vector3d& sensor) {
      return plane.up.dot (sensor) - plane.height > rise * sensor.norm ();
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
      if (!isSeenFrom (plane, least_rise))
        continue;
      if (const std::size_t count = endsNear (plane, rough_reach).size (); count > most)
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
    plane.height = heightAlong (plane.up, lines_, outlier_share);
    return plane;
  }

  bool isContact (const Plane& plane) const
  {
    if (!isSeenFrom (plane, least_rise) ||
        heightAlong (plane.up, lines_, 1.0 - outlier_share) - plane.height < least_height ||
        showsUnderside (plane.up, lines_, underside, underside_share))
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
    const Demand& demand = isSeenFrom (plane, silhouette_rise) ? of_silhouettes
                           : sensors_.size () > 1              ? of_several
                                                               : of_one_sensor;
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
inferredSupportPlane (const std::vector<OrientedPoint>& points)
{
  if (points.size () < least_points)
    return std::nullopt;
  const NormalLines normals = normalLinesOf (points);
  std::optional<Eigen::Vector3d> up = normals.lines.empty () ? std::nullopt : rimNormal (normals.lines);
  if (!up)
    return std::nullopt;
  if (const std::vector<Eigen::Vector3d> floor = Surroundings (normals.lines, *up).floor ();
      floor.size () >= least_floor)
    up = planeNormal (floor, *up);
  const Surroundings around (normals.lines, *up);
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : around.floor ())
    heights.push_back (up->dot (p));
  if (heights.size () < least_floor || showsUnderside (*up, normals.lines, facing_down, down_share))
    return std::nullopt;
  const double floor = quantile (heights, 0.5);
  const double wall = usual_wall * around.radius ();
  if (around.sectorsHigherThan (floor + std::max (wall, lid_rise * around.radius ())) < higher_sectors)
    return std::nullopt;
  return inMetres ({*up, std::min (floor - wall, heightAlong (*up, normals.lines, outlier_share))}, normals);
}

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
