// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_depth_buffer.h"

#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double rounding = 1e-9; // relative bound of the rounding errors of a box's depths
constexpr double slack_px = 1.0;  // bound of the errors of its pixels
constexpr float infinity = std::numeric_limits<float>::infinity ();

} // namespace

ObjectDepthBuffer::ObjectDepthBuffer (const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor)
    : camera_ (camera)
    , T_sensor_object_ (T_object_sensor.inverse ())
{}

bool
ObjectDepthBuffer::find (const Eigen::Vector3d& p, int& u, int& v) const
{
  const std::optional<Eigen::Array2i> pixel = pixelOf (camera_, p);
  if (!pixel)
    return false;
  u = pixel->x ();
  v = pixel->y ();
  return true;
}

void
ObjectDepthBuffer::extend (const Eigen::Array2i& low, const Eigen::Array2i& high)
{
  const bool empty = depth_.empty ();
  const Eigen::Array2i first = empty ? low : Eigen::Array2i (low.min (first_));
  const Eigen::Array2i size = (empty ? high : Eigen::Array2i (high.max (first_ + size_ - 1))) - first + 1;
  if (!empty && (first == first_).all () && (size == size_).all ())
    return;
  const std::size_t cells = static_cast<std::size_t> (size.x ()) * size.y ();
  std::vector<float> depth (cells, infinity);
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
    int column, row; // of cells
    float depth;
  };
  std::vector<Sighting> seen;
  seen.reserve (points.size () - first);
  Eigen::Array2i low = Eigen::Array2i::Constant (std::numeric_limits<int>::max ());
  Eigen::Array2i high = Eigen::Array2i::Constant (-1);
  for (std::size_t n = first; n < points.size (); ++n)
  {
    const Eigen::Vector3d p = T_sensor_object_ * points[n].position.cast<double> ();
    int u = 0;
    int v = 0;
    if (!find (p, u, v))
      continue;
    seen.push_back ({u / cell_px, v / cell_px, static_cast<float> (p.z ())});
    low = low.min (Eigen::Array2i (seen.back ().column, seen.back ().row));
    high = high.max (Eigen::Array2i (seen.back ().column, seen.back ().row));
  }
  if (seen.empty ())
    return;
  extend (low, high);
  for (const Sighting& sighting : seen)
  {
    const std::size_t cell = static_cast<std::size_t> (sighting.row - first_.y ()) * size_.x () + sighting.column -
                             first_.x ();
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
  int u = 0;
  int v = 0;
  if (!find (q, u, v))
    return Hidden::Nothing;
  if (q.z () > depthOf (u, v))
    return Hidden::ByObject;
  return compareWithReading (q.z (), view.at (u, v), 0.0) == PointVisibility::Occluded ? Hidden::ByOther
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
  const Eigen::Array2i first = low.max (0.0).cast<int> () / cell_px - first_;
  const Eigen::Array2i last = high.min (end - 1.0).cast<int> () / cell_px - first_;
  covered = covered && (first >= 0).all () && (last < size_).all ();
  for (int v = std::max (0, first.y ()); v <= std::min (size_.y () - 1, last.y ()); ++v)
    for (int u = std::max (0, first.x ()); u <= std::min (size_.x () - 1, last.x ()); ++u)
    {
      const std::size_t cell = static_cast<std::size_t> (v) * size_.x () + u;
      const bool before_some = depth_[cell] < farthest;
      outlook.may_be_hidden |= before_some;
      outlook.may_have_changed |= before_some && changed_[cell] != 0;
      covered = covered && depth_[cell] < nearest;
    }
  outlook.all_hidden = covered;
  return outlook;
}

} // namespace pcl::cosection
