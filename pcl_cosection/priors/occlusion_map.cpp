// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "occlusion_map.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double rounding = 1e-9; // relative bound of the rounding errors of a box's depths
constexpr double slack_px = 1.0;  // bound of the errors of its pixels
constexpr int tile_size = 8;      // voxels along each side

} // namespace

ObjectDepthBuffer::ObjectDepthBuffer (const DepthView& view, const Eigen::Isometry3d& T_object_sensor,
                                      const std::vector<OrientedPoint>& points)
    : view_ (&view)
    , T_sensor_object_ (T_object_sensor.inverse ())
{
  std::vector<std::pair<Eigen::Array2i, float>> seen; // cell, depth
  seen.reserve (points.size ());
  Eigen::Array2i low = Eigen::Array2i::Constant (std::numeric_limits<int>::max ());
  Eigen::Array2i high = Eigen::Array2i::Constant (-1);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = T_sensor_object_ * point.position.cast<double> ();
    const std::optional<Eigen::Array2i> pixel = pixelOf (view.camera, p);
    if (!pixel)
      continue;
    seen.emplace_back (*pixel / outline_cell_px, static_cast<float> (p.z ()));
    low = low.min (seen.back ().first);
    high = high.max (seen.back ().first);
  }
  if (seen.empty ())
    return;
  first_ = low;
  size_ = high - low + 1;
  depth_.assign (static_cast<std::size_t> (size_.x ()) * size_.y (), std::numeric_limits<float>::infinity ());
  for (const auto& [cell, depth] : seen)
    depth_[indexOf (cell - first_)] = std::min (depth_[indexOf (cell - first_)], depth);
}

Hidden
ObjectDepthBuffer::at (const Eigen::Vector3d& p) const
{
  const Eigen::Vector3d q = T_sensor_object_ * p;
  const std::optional<Eigen::Array2i> pixel = pixelOf (view_->camera, q);
  if (!pixel)
    return Hidden::Nothing;
  const Eigen::Array2i cell = *pixel / outline_cell_px - first_;
  if ((cell >= 0).all () && (cell < size_).all () && q.z () > depth_[indexOf (cell)])
    return Hidden::ByObject;
  return compareWithReading (q.z (), view_->at (pixel->x (), pixel->y ()), 0.0) == PointVisibility::Occluded
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
    return outlook;
  }
  Eigen::Array2d low = Eigen::Array2d::Constant (std::numeric_limits<double>::infinity ());
  Eigen::Array2d high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sense ((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0, (corner & 4) ? 1.0 : -1.0);
    const Eigen::Array2d pixel = view_->camera.project (middle + arms * sense).array () + 0.5;
    low = low.min (pixel);
    high = high.max (pixel);
  }
  low -= slack_px;
  high += slack_px;
  const Eigen::Array2d end (view_->camera.width, view_->camera.height);
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
      const float depth = depth_[indexOf ({u, v})];
      outlook.may_be_hidden |= depth < farthest;
      covered = covered && depth < nearest;
    }
  outlook.all_hidden = covered;
  return outlook;
}

OcclusionMap::OcclusionMap (const Views& views, const std::vector<OrientedPoint>& points, int threads)
{
  std::vector<std::optional<ObjectDepthBuffer>> buffers (views.size ());
  parallelFor (0, static_cast<int> (views.size ()), threads,
               [&] (int v) { buffers[v].emplace (*views[v].first, views[v].second, points); });
  for (std::optional<ObjectDepthBuffer>& buffer : buffers)
    depth_buffers_.push_back (std::move (*buffer));
}

Hidden
OcclusionMap::at (const Eigen::Vector3d& p) const
{
  Hidden hidden = depth_buffers_.empty () ? Hidden::ByObject : Hidden::Nothing;
  for (std::size_t v = 0; v < depth_buffers_.size () && hidden != Hidden::ByObject; ++v)
    hidden = std::max (hidden, depth_buffers_[v].at (p));
  return hidden;
}

bool
OcclusionMap::isBehindOther (const Eigen::Vector3d& p) const
{
  return std::any_of (depth_buffers_.begin (), depth_buffers_.end (),
                      [&] (const ObjectDepthBuffer& buffer) { return buffer.at (p) == Hidden::ByOther; });
}

std::vector<Hidden>
OcclusionMap::ofVoxels (const VoxelGrid& grid, const std::vector<std::uint8_t>& wanted, int threads) const
{
  std::vector<Hidden> hidden (grid.size (), depth_buffers_.empty () ? Hidden::ByObject : Hidden::Nothing);
  const Eigen::Array3i tiles = (grid.dims.array () + tile_size - 1) / tile_size;
  parallelFor (0, tiles.prod (), threads, [&] (int t) {
    const Eigen::Array3i tile (t % tiles.x (), t / tiles.x () % tiles.y (), t / (tiles.x () * tiles.y ()));
    const Eigen::Vector3i first = tile_size * tile;
    const Eigen::Vector3i last = (first.array () + tile_size).min (grid.dims.array ()) - 1;
    std::vector<std::pair<std::size_t, Eigen::Vector3d>> open; // voxels which the object does not hide so far
    for (int k = first.z (); k <= last.z (); ++k)
      for (int j = first.y (); j <= last.y (); ++j)
        for (int i = first.x (); i <= last.x (); ++i)
          if (const std::size_t n = grid.index (i, j, k); wanted[n])
            open.emplace_back (n, grid.center (i, j, k));
    const Eigen::Vector3d low = grid.center (first.x (), first.y (), first.z ());
    const Eigen::Vector3d high = grid.center (last.x (), last.y (), last.z ());
    for (const ObjectDepthBuffer& buffer : depth_buffers_)
    {
      if (open.empty ())
        return;
      const ObjectDepthBuffer::Outlook outlook = buffer.outlook (0.5 * (low + high), 0.5 * (high - low));
      if (!outlook.in_view)
        continue;
      for (const auto& [n, center] : open)
        if (outlook.all_hidden)
          hidden[n] = Hidden::ByObject;
        else if (outlook.may_be_hidden || hidden[n] == Hidden::Nothing)
          hidden[n] = std::max (hidden[n], buffer.at (center));
      open.erase (std::remove_if (open.begin (), open.end (),
                                  [&] (const auto& place) { return hidden[place.first] == Hidden::ByObject; }),
                  open.end ());
    }
  });
  return hidden;
}

std::size_t
OcclusionMap::bytes () const
{
  std::size_t bytes = 0;
  for (const ObjectDepthBuffer& buffer : depth_buffers_)
    bytes += buffer.bytes ();
  return bytes;
}

} // namespace pcl::cosection
