// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "extrusion.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int border_cells = 3;
constexpr int least_around = 4;        // of nine cells with points: a cell is inside
constexpr double near_plane_vox = 3.0; // free space so near to the plane or to the surface is not observable ...
// ... and level tops whose heights differ by less are one
constexpr double most_cut = 0.2;          // of the columns: vertical walls
constexpr int beside_cells = 2;           // walls are in columns so near to a level top
constexpr double least_level = 0.8;       // of the columns: all but the walls below the top
constexpr float gap_vox = 2.0f;           // nothing is expected nearer to data
constexpr double below_top_vox = 1.5;     // free space at least so far below a top is beside it, not above it
constexpr float far_vox = 6.0f;           // largest expected distance
constexpr float deep_vox = 3.0f;          // farther inside nothing need be expected
constexpr float wall_weight = 10.0f;      // in multiples of beta_extent
constexpr float expected_free_vox = 1.0f; // lower bound of another expectation, that there is nothing

} // namespace

Extrusion::Extrusion (const BodyEnergy& energy, const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane)
    : energy_ (energy)
    , plane_ (plane)
    , up_ (plane.head<3> ())
    , cell_m_ (energy.grid.voxel_size_m)
{
  const Eigen::Matrix3d axes = principalAxes (points, up_);
  across_ = axes.col (0);
  along_ = axes.col (1);
  raise (points);
  if (map_.empty ())
    return;
  fillGaps ();
  for (const Column& column : map_)
    top_m_ = std::max<double> (top_m_, column.height_m);
  has_walls_ = cutShare () < most_cut;
  is_level_ = has_walls_ && levelShare () > least_level;
}

void
Extrusion::raise (const std::vector<OrientedPoint>& points)
{
  Eigen::AlignedBox2d box;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if (energy_.grid.nearest (p))
      box.extend (Eigen::Vector2d (across_.dot (p), along_.dot (p)));
  }
  if (box.isEmpty ())
    return;
  first_ = box.min () - Eigen::Vector2d::Constant (border_cells * cell_m_);
  columns_ = static_cast<int> (box.sizes ().x () / cell_m_) + 1 + 2 * border_cells;
  rows_ = static_cast<int> (box.sizes ().y () / cell_m_) + 1 + 2 * border_cells;
  map_.assign (static_cast<std::size_t> (columns_) * rows_, {});
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    const int cell = cellOf (p);
    const auto height_m = static_cast<float> (heightOver (p));
    if (cell >= 0 && energy_.grid.nearest (p) && height_m > map_[cell].height_m)
    {
      map_[cell].height_m = height_m;
      map_[cell].upwards = static_cast<float> (up_.dot (point.normal.cast<double> ()));
    }
  }
}

int
Extrusion::cellOf (const Eigen::Vector3d& place) const
{
  const Eigen::Array2d at = (Eigen::Array2d (across_.dot (place), along_.dot (place)) - first_.array ()) / cell_m_;
  return at.x () >= 0.0 && at.y () >= 0.0 && at.x () < columns_ && at.y () < rows_
             ? static_cast<int> (at.y ()) * columns_ + static_cast<int> (at.x ())
             : -1;
}

Eigen::Vector3d
Extrusion::placeOf (int column, int row, double height_m) const
{
  return (first_.x () + (column + 0.5) * cell_m_) * across_ + (first_.y () + (row + 0.5) * cell_m_) * along_ +
         (height_m - plane_[3]) * up_;
}

/** \brief Heights of cells most of which are among cells with points: the larger of their own and the median around. */
void
Extrusion::fillGaps ()
{
  const std::vector<Column> before = map_;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
    {
      std::array<Column, 9> around{};
      int count = 0;
      for (int r = std::max (0, row - 1); r <= std::min (rows_ - 1, row + 1); ++r)
        for (int c = std::max (0, column - 1); c <= std::min (columns_ - 1, column + 1); ++c)
          if (const Column& other = before[static_cast<std::size_t> (r) * columns_ + c]; other.height_m > 0.0f)
            around[static_cast<std::size_t> (count++)] = other;
      Column& own = at (column, row);
      if (count < least_around)
      {
        own = {};
        continue;
      }
      std::nth_element (around.begin (), around.begin () + count / 2, around.begin () + count,
                        [] (const Column& a, const Column& b) { return a.height_m < b.height_m; });
      if (const Column& median = around[static_cast<std::size_t> (count / 2)]; median.height_m > own.height_m)
        own = median;
    }
}

bool
Extrusion::isFree (const Eigen::Vector3d& place) const
{
  const auto voxel = energy_.grid.nearest (place);
  return voxel && energy_.empty[energy_.grid.index (voxel->x (), voxel->y (), voxel->z ())];
}

/** \brief Whether there is free space above a place, between two heights over it. */
bool
Extrusion::isFreeBetween (const Eigen::Vector3d& place, double low_m, double high_m) const
{
  for (double height_m = low_m; height_m < high_m; height_m += cell_m_)
    if (isFree (place + height_m * up_))
      return true;
  return false;
}

/** \brief Share of the columns that free space cuts, of those high enough to tell. */
double
Extrusion::cutShare () const
{
  std::size_t high = 0, cut = 0;
  const double margin_m = near_plane_vox * cell_m_;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      if (const double height_m = at (column, row).height_m; height_m > 2.0 * margin_m)
      {
        ++high;
        cut += isFreeBetween (placeOf (column, row, 0.0), margin_m, height_m - margin_m);
      }
  return high > 0 ? static_cast<double> (cut) / static_cast<double> (high) : 0.0;
}

/** \brief Share of the columns that a level top covers, or that are beside such columns. */
double
Extrusion::levelShare () const
{
  std::size_t all = 0, level_ones = 0;
  const double one_level = near_plane_vox * cell_m_;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
    {
      if (!(at (column, row).height_m > 0.0f))
        continue;
      ++all;
      bool near = false;
      for (int r = std::max (0, row - beside_cells); r <= std::min (rows_ - 1, row + beside_cells); ++r)
        for (int c = std::max (0, column - beside_cells); c <= std::min (columns_ - 1, column + beside_cells); ++c)
          near |= at (c, r).height_m > top_m_ - one_level && at (c, r).upwards > level_top_cosine;
      level_ones += near;
    }
  return all > 0 ? static_cast<double> (level_ones) / static_cast<double> (all) : 0.0;
}

void
Extrusion::emptyBesideTops (Proposal& proposal) const
{
  if (!is_level_)
    return;
  const VoxelGrid& grid = energy_.grid;
  const double highest_m = top_m_ - below_top_vox * grid.voxel_size_m;
  std::vector<std::uint8_t> inside (grid.size (), 1);
  parallelFor (0, grid.dims.z (), threadsForVoxels (energy_.options.threads, grid.size ()), [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        for (Eigen::Vector3d place = grid.center (i, j, k); heightOver (place) < highest_m; place += cell_m_ * up_)
        {
          const auto voxel = grid.nearest (place);
          if (!voxel)
            break;
          const std::size_t above = grid.index (voxel->x (), voxel->y (), voxel->z ());
          if (energy_.data_distance_vox[above] < gap_vox)
            break;
          if (!energy_.empty[above])
            continue;
          inside[grid.index (i, j, k)] = 0;
          break;
        }
  });
  const std::vector<float> distance_vox = distanceTransform (grid.dims, inside, energy_.options.threads);
  for (std::size_t n = 0; n < grid.size (); ++n)
    if (!(proposal.weight[n] > 0.0f) && distance_vox[n] > expected_free_vox)
      proposal.least[n] = std::max (proposal.least[n], std::min (distance_vox[n], far_vox));
}

void
Extrusion::addTo (Proposal& proposal, double below_m) const
{
  if (map_.empty ())
    return;
  const VoxelGrid& grid = energy_.grid;
  std::vector<std::uint8_t> inside (grid.size (), 0), outside (grid.size (), 1);
  std::vector<float> height_vox (grid.size ());
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const Eigen::Vector3d place = grid.center (i, j, k);
        const double height_m = heightOver (place);
        const int cell = cellOf (place);
        if (energy_.empty[n] || cell < 0 || height_m < -cell_m_ || height_m > below_m)
          continue;
        const double top_m = map_[static_cast<std::size_t> (cell)].height_m;
        if (!(top_m > height_m) || proposal.least[n] > expected_free_vox ||
            isFreeBetween (place, cell_m_, top_m - height_m - cell_m_))
          continue;
        inside[n] = 1;
        outside[n] = 0;
        height_vox[n] = static_cast<float> (height_m / grid.voxel_size_m);
        proposal.unbounded[n] = 1;
      }
  if (!has_walls_)
    return;
  const std::vector<float> depth_vox = distanceTransform (grid.dims, outside, energy_.options.threads);
  const float weight = wall_weight * static_cast<float> (energy_.options.beta_extent);
  for (std::size_t n = 0; n < grid.size (); ++n)
  {
    const float target = std::max (0.5f - depth_vox[n], -height_vox[n]); // it ends at the plane
    if (!inside[n] || energy_.data_distance_vox[n] < gap_vox || target <= -deep_vox || proposal.weight[n] > 0.0f)
      continue; // copies are more exact than columns
    proposal.target[n] = target;
    proposal.weight[n] = weight;
  }
}

} // namespace pcl::cosection
