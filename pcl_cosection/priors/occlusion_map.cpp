// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "occlusion_map.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::uint8_t stale = 4;

bool
sameGrid (const VoxelGrid& a, const VoxelGrid& b)
{
  return a.dims == b.dims && a.voxel_size_m == b.voxel_size_m && a.origin_m == b.origin_m;
}

} // namespace

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
OcclusionMap::clear ()
{
  *this = OcclusionMap ();
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
  if (sameGrid (grid, grid_) && known_.size () == grid.size ())
    return;
  grid_ = grid;
  known_.assign (grid.size (), stale);
}

void
OcclusionMap::find (const VoxelTile& tile, const std::vector<std::uint8_t>& wanted, std::vector<Hidden>& hidden)
{
  struct Place
  {
    Eigen::Vector3d center;
    std::size_t index;    // voxel of the grid
    std::size_t position; // in the tile
    bool stale;
  };
  std::vector<Place> open;
  hidden.assign (wanted.size (), Hidden::Nothing);
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
