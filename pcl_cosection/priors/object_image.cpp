// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_image.h"

#include "pcl_cosection/view/visibility/free_space_view.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int edge_px = 4;           // width of the readings at edges that are left out
constexpr float alike_cosine = 0.7f; // of two normals of one surface

bool
isIn (const PinholeCamera& camera, const Eigen::Array2i& pixel)
{
  return (pixel >= 0).all () && pixel.x () < camera.width && pixel.y () < camera.height;
}

} // namespace

ObjectImage::ObjectImage (const DepthView& view, const Eigen::Isometry3d& T_object_sensor,
                          const std::vector<OrientedPoint>& points, double voxel_size_m)
    : view_ (view)
    , T_sensor_object_ (T_object_sensor.inverse ())
    , points_ (points)
    , voxel_size_m_ (voxel_size_m)
    , point_of_ (static_cast<std::size_t> (view.camera.width) * view.camera.height, none)
{
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    const Eigen::Vector3d q = T_sensor_object_ * points[p].position.cast<double> ();
    const auto pixel = pixelOf (view.camera, q);
    if (pixel && marginOf (q.z ()) > std::abs (view.at (pixel->x (), pixel->y ()) - q.z ()))
      point_of_[indexOf (*pixel)] = static_cast<std::uint32_t> (p);
  }
  growIntoEdges ();
}

double
ObjectImage::marginOf (double depth_m) const
{
  return freeSpaceMargin (view_, depth_m, voxel_size_m_);
}

void
ObjectImage::growIntoEdges ()
{
  const std::vector<std::uint32_t> before = point_of_;
  const PinholeCamera& camera = view_.camera;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (const std::uint32_t own = before[indexOf ({u, v})]; own != none)
        for (int row = std::max (0, v - edge_px); row <= std::min (camera.height - 1, v + edge_px); ++row)
          for (int column = std::max (0, u - edge_px); column <= std::min (camera.width - 1, u + edge_px); ++column)
            if (std::uint32_t& other = point_of_[indexOf ({column, row})];
                other == none && std::abs (view_.at (column, row) - view_.at (u, v)) < marginOf (view_.at (u, v)))
              other = own;
}

Shown
ObjectImage::at (const OrientedPoint& point) const
{
  const Eigen::Vector3d q = T_sensor_object_ * point.position.cast<double> ();
  const auto pixel = pixelOf (view_.camera, q);
  if (!pixel)
    return Shown::Nothing;
  const std::uint32_t own = point_of_[indexOf (*pixel)];
  switch (compareWithReading (q.z (), view_.at (pixel->x (), pixel->y ()), marginOf (q.z ())))
  {
  case PointVisibility::Free:
    return Shown::Free;
  case PointVisibility::Occluded:
    return own == none ? Shown::BehindOther : Shown::BehindOwn;
  case PointVisibility::AtSurface:
    return own == none                                             ? Shown::Nothing
           : points_[own].normal.dot (point.normal) > alike_cosine ? Shown::Object
                                                                   : Shown::Turned;
  default:
    return Shown::Nothing;
  }
}

bool
ObjectImage::isBehindNearer (const OrientedPoint& place, const OrientedPoint& point) const
{
  const double depth_m = (T_sensor_object_ * point.position.cast<double> ()).z ();
  const Eigen::Vector3d q = T_sensor_object_ * place.position.cast<double> ();
  const auto pixel = pixelOf (view_.camera, q);
  return pixel && point_of_[indexOf (*pixel)] == none &&
         compareWithReading (std::min (depth_m, q.z ()), view_.at (pixel->x (), pixel->y ()), marginOf (depth_m)) ==
             PointVisibility::Occluded;
}

std::optional<Eigen::Array2i>
ObjectImage::firstReading (const Eigen::Array2i& pixel, const Eigen::Array2i& step, int steps) const
{
  for (int n = 1; n <= steps; ++n)
  {
    const Eigen::Array2i beyond = pixel + n * step;
    if (!isIn (view_.camera, beyond))
      break;
    if (isReading (view_.at (beyond.x (), beyond.y ())))
      return beyond;
  }
  return std::nullopt;
}

std::optional<double>
ObjectImage::hiddenOutline (bool is_cut_out, const std::function<bool (const Eigen::Vector3d&)>& hides_nothing) const
{
  const Eigen::Isometry3d T_object_sensor = T_sensor_object_.inverse ();
  Eigen::AlignedBox2i box;
  for (int v = 0; v < view_.camera.height; ++v)
    for (int u = 0; u < view_.camera.width; ++u)
      if (point_of_[indexOf ({u, v})] != none)
        box.extend (Eigen::Vector2i (u, v));
  if (box.isEmpty ())
    return std::nullopt;
  const int reach = is_cut_out ? edge_px : std::max (edge_px, box.sizes ().maxCoeff ());
  const auto isHidden = [&] (const Eigen::Array2i& pixel, const Eigen::Array2i& step) {
    const std::optional<Eigen::Array2i> beyond = firstReading (pixel, step, reach);
    if (!beyond)
      return false;
    const double depth_m = view_.at (pixel.x (), pixel.y ()), reading_m = view_.at (beyond->x (), beyond->y ());
    return compareWithReading (depth_m, reading_m, marginOf (depth_m)) == PointVisibility::Occluded &&
           !hides_nothing (T_object_sensor * view_.camera.unproject (beyond->x (), beyond->y (), reading_m));
  };
  std::size_t all = 0, hidden = 0;
  for (int v = box.min ().y (); v <= box.max ().y (); ++v)
    for (int u = box.min ().x (); u <= box.max ().x (); ++u)
      if (const Eigen::Array2i pixel (u, v); point_of_[indexOf (pixel)] != none)
        for (const Eigen::Array2i& step : {Eigen::Array2i (1, 0), {-1, 0}, {0, 1}, {0, -1}})
          if (const Eigen::Array2i next = pixel + step; !isIn (view_.camera, next) || point_of_[indexOf (next)] == none)
          {
            ++all;
            hidden += isHidden (pixel, step) ? 1 : 0;
          }
  return static_cast<double> (hidden) / static_cast<double> (all);
}

} // namespace pcl::cosection
