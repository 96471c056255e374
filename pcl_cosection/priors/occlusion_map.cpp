// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "occlusion_map.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double rounding = 1e-9; // relative bound of the rounding errors of a box's depths
constexpr double slack_px = 1.0;  // bound of the errors of its pixels
constexpr std::uint8_t stale = 4;

} // namespace

void
ObjectDepthBuffer::extend (const Eigen::Array2i& low, const Eigen::Array2i& high)
{
  const bool empty = depth_.empty ();
  const Eigen::Array2i first = empty ? low : Eigen::Array2i (low.min (first_));
  const Eigen::Array2i size = (empty ? high : Eigen::Array2i (high.max (first_ + size_ - 1))) - first + 1;
  if (!empty && (first == first_).all () && (size == size_).all ())
    return;
  const std::size_t cells = static_cast<std::size_t> (size.x ()) * size.y ();
  std::vector<float> depth (cells, std::numeric_limits<float>::infinity ());
  std::vector<std::uint8_t> changed (cells, 0);
  const Eigen::Array2i shift = first_ - first;
  for (int v = 0; v < size_.y (); ++v)
  {
    const auto from = static_cast<std::ptrdiff_t> (v) * size_.x ();
    const auto to = static_cast<std::ptrdiff_t> (v + shift.y ()) * size.x () + shift.x ();
    std::copy_n (depth_.begin () + from, size_.x (), depth.begin () + to);
    std::copy_n (changed_.begin () + from, size_.x (), changed.begin () + to);
  }
  depth_ = std::move (depth);
  changed_ = std::move (changed);
  first_ = first;
  size_ = size;
}

void
ObjectDepthBuffer::add (const std::vector<OrientedPoint>& points, std::size_t first)
{
  struct Sighting
  {
    Eigen::Array2i cell;
    float depth;
  };
  std::vector<Sighting> seen;
  seen.reserve (points.size () - first);
  Eigen::Array2i low = Eigen::Array2i::Constant (std::numeric_limits<int>::max ());
  Eigen::Array2i high = Eigen::Array2i::Constant (-1);
  for (std::size_t n = first; n < points.size (); ++n)
  {
    const Eigen::Vector3d p = T_sensor_object_ * points[n].position.cast<double> ();
    const std::optional<Eigen::Array2i> pixel = pixelOf (camera_, p);
    if (!pixel)
      continue;
    seen.push_back ({*pixel / outline_cell_px, static_cast<float> (p.z ())});
    low = low.min (seen.back ().cell);
    high = high.max (seen.back ().cell);
  }
  if (seen.empty ())
    return;
  extend (low, high);
  for (const Sighting& sighting : seen)
  {
    const std::size_t cell = indexOf (sighting.cell.x () - first_.x (), sighting.cell.y () - first_.y ());
    if (sighting.depth < depth_[cell])
    {
      depth_[cell] = sighting.depth;
      changed_[cell] = 1;
      any_changed_ = true;
    }
  }
}

void
ObjectDepthBuffer::settle ()
{
  if (any_changed_)
    std::fill (changed_.begin (), changed_.end (), std::uint8_t (0));
  any_changed_ = false;
}

Hidden
ObjectDepthBuffer::at (const Eigen::Vector3d& p, const DepthView& view) const
{
  const Eigen::Vector3d q = T_sensor_object_ * p;
  const std::optional<Eigen::Array2i> pixel = pixelOf (camera_, q);
  if (!pixel)
    return Hidden::Nothing;
  const Eigen::Array2i cell = *pixel / outline_cell_px - first_;
  if ((cell >= 0).all () && (cell < size_).all () && q.z () > depth_[indexOf (cell.x (), cell.y ())])
    return Hidden::ByObject;
  return compareWithReading (q.z (), view.at (pixel->x (), pixel->y ()), 0.0) == PointVisibility::Occluded
             ? Hidden::ByOther
             : Hidden::Nothing;
}

ObjectDepthBuffer::Outlook
ObjectDepthBuffer::outlook (const Eigen::Vector3d& center, const Eigen::Vector3d& half_sizes) const
{
  const Eigen::Vector3d middle = T_sensor_object_ * center;
  const Eigen::Matrix3d arms = T_sensor_object_.linear () * half_sizes.asDiagonal ();
  const double reach = arms.row (2).cwiseAbs ().sum ();
  const double nearest = (middle.z () - reach) * (1.0 - rounding);
  const double farthest = (middle.z () + reach) * (1.0 + rounding);
  Outlook outlook;
  if (farthest <= 0.0)
    return outlook;
  if (nearest <= 0.0) // its projection is unbounded
  {
    outlook.in_view = outlook.may_be_hidden = true;
    outlook.may_have_changed = any_changed_;
    return outlook;
  }
  Eigen::Array2d low = Eigen::Array2d::Constant (std::numeric_limits<double>::infinity ());
  Eigen::Array2d high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sense ((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0, (corner & 4) ? 1.0 : -1.0);
    const Eigen::Array2d pixel = camera_.project (middle + arms * sense).array () + 0.5;
    low = low.min (pixel);
    high = high.max (pixel);
  }
  low -= slack_px;
  high += slack_px;
  const Eigen::Array2d end (camera_.width, camera_.height);
  if ((high < 0.0).any () || (low >= end).any ())
    return outlook;
  outlook.in_view = true;
  bool covered = (low >= 0.0).all () && (high < end).all (); // all cells are nearer than the box
  const Eigen::Array2i first = low.max (0.0).cast<int> () / outline_cell_px - first_;
  const Eigen::Array2i last = high.min (end - 1.0).cast<int> () / outline_cell_px - first_;
  covered = covered && (first >= 0).all () && (last < size_).all ();
  for (int v = std::max (0, first.y ()); v <= std::min (size_.y () - 1, last.y ()); ++v)
    for (int u = std::max (0, first.x ()); u <= std::min (size_.x () - 1, last.x ()); ++u)
    {
      const std::size_t cell = indexOf (u, v);
      const bool before_some = depth_[cell] < farthest;
      outlook.may_be_hidden |= before_some;
      outlook.may_have_changed |= before_some && changed_[cell] != 0;
      covered = covered && depth_[cell] < nearest;
    }
  outlook.all_hidden = covered;
  return outlook;
}

std::vector<VoxelTile>
tilesOf (const VoxelGrid& grid)
{
  std::vector<VoxelTile> tiles;
  for (int k = 0; k < grid.dims.z (); k += VoxelTile::size)
    for (int j = 0; j < grid.dims.y (); j += VoxelTile::size)
      for (int i = 0; i < grid.dims.x (); i += VoxelTile::size)
      {
        const Eigen::Vector3i first (i, j, k);
        tiles.push_back ({first, (first.array () + VoxelTile::size).min (grid.dims.array ())});
      }
  return tiles;
}

void
OcclusionMap::add (const Views& views, const std::vector<OrientedPoint>& points, int threads)
{
  const auto same = [] (const auto& a, const auto& b) { return a.second.matrix () == b.second.matrix (); };
  if (views.size () < views_.size () || points.size () < points_ ||
      !std::equal (views_.begin (), views_.end (), views.begin (), same))
    clear ();
  const std::size_t earlier = depth_buffers_.size ();
  for (std::size_t v = earlier; v < views.size (); ++v)
    depth_buffers_.emplace_back (views[v].first->camera, views[v].second);
  parallelFor (0, static_cast<int> (views.size ()), threads,
               [&] (int v) { depth_buffers_[v].add (points, static_cast<std::size_t> (v) < earlier ? points_ : 0); });
  points_ = points.size ();
  views_ = views;
}

Hidden
OcclusionMap::at (const Eigen::Vector3d& p) const
{
  Hidden hidden = views_.empty () ? Hidden::ByObject : Hidden::Nothing;
  for (std::size_t v = 0; v < views_.size () && hidden != Hidden::ByObject; ++v)
    hidden = std::max (hidden, depth_buffers_[v].at (p, *views_[v].first));
  return hidden;
}

bool
OcclusionMap::isBehindOther (const Eigen::Vector3d& p) const
{
  for (std::size_t v = 0; v < views_.size (); ++v)
    if (depth_buffers_[v].at (p, *views_[v].first) == Hidden::ByOther)
      return true;
  return false;
}

void
OcclusionMap::begin (const VoxelGrid& grid)
{
  if (grid.dims == grid_.dims && grid.voxel_size_m == grid_.voxel_size_m && grid.origin_m == grid_.origin_m &&
      known_.size () == grid.size ())
    return;
  grid_ = grid;
  known_.assign (grid.size (), stale);
}

std::vector<Hidden>
OcclusionMap::find (const VoxelTile& tile, const std::vector<std::uint8_t>& wanted)
{
  struct Place
  {
    Eigen::Vector3d center;
    std::size_t index;    // voxel of the grid
    std::size_t position; // in the tile
    bool stale;
  };
  std::vector<Place> open;
  std::vector<Hidden> hidden (wanted.size (), Hidden::Nothing);
  bool any_stale = false;
  std::size_t position = 0;
  for (int k = tile.first.z (); k < tile.end.z (); ++k)
    for (int j = tile.first.y (); j < tile.end.y (); ++j)
      for (int i = tile.first.x (); i < tile.end.x (); ++i, ++position)
      {
        const std::size_t n = grid_.index (i, j, k);
        if (!wanted[position])
        {
          known_[n] |= stale;
          continue;
        }
        const bool was_stale = (known_[n] & stale) != 0;
        known_[n] &= static_cast<std::uint8_t> (~stale);
        hidden[position] = views_.empty () ? Hidden::ByObject : static_cast<Hidden> (known_[n]);
        if (hidden[position] == Hidden::ByObject)
          continue;
        any_stale |= was_stale;
        open.push_back ({grid_.center (i, j, k), n, position, was_stale});
      }

  const Eigen::Vector3d low = grid_.center (tile.first.x (), tile.first.y (), tile.first.z ());
  const Eigen::Vector3d high = grid_.center (tile.end.x () - 1, tile.end.y () - 1, tile.end.z () - 1);
  for (std::size_t v = 0; v < depth_buffers_.size () && !open.empty (); ++v)
  {
    const ObjectDepthBuffer& silhouette = depth_buffers_[v];
    const bool fresh = v >= views_known_;
    if (!fresh && !any_stale && !silhouette.changed ())
      continue;
    const ObjectDepthBuffer::Outlook outlook = silhouette.outlook (0.5 * (low + high), 0.5 * (high - low));
    if (!outlook.in_view || (!fresh && !any_stale && !outlook.may_have_changed))
      continue;
    std::size_t left = 0;
    for (const Place& place : open)
    {
      Hidden& value = hidden[place.position];
      if (outlook.all_hidden)
        value = Hidden::ByObject;
      else if ((fresh || place.stale || outlook.may_have_changed) &&
               (outlook.may_be_hidden || value == Hidden::Nothing))
        value = std::max (value, silhouette.at (place.center, *views_[v].first));
      if (value != Hidden::ByObject)
        open[left++] = place;
      else
        known_[place.index] = static_cast<std::uint8_t> (value);
    }
    open.resize (left);
  }
  for (const Place& place : open)
    known_[place.index] = static_cast<std::uint8_t> (hidden[place.position]);
  return hidden;
}

void
OcclusionMap::end ()
{
  views_known_ = views_.size ();
  for (ObjectDepthBuffer& silhouette : depth_buffers_)
    silhouette.settle ();
}

std::size_t
OcclusionMap::bytes () const
{
  std::size_t bytes = known_.capacity ();
  for (const ObjectDepthBuffer& silhouette : depth_buffers_)
    bytes += sizeof (ObjectDepthBuffer) + silhouette.bytes ();
  return bytes;
}

} // namespace pcl::cosection
