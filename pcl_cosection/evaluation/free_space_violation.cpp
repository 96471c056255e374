// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "free_space_violation.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl::cosection {
namespace {

/** \brief The nearest of the four readings around a pixel; nothing where one is missing. */
std::optional<double>
nearestReading (const DepthView& view, const Eigen::Vector2d& pixel)
{
  const Eigen::Array2d corner = pixel.array ().floor ();
  if (!(corner.minCoeff () >= 0.0 && corner.x () < view.camera.width - 1 && corner.y () < view.camera.height - 1))
    return std::nullopt;
  const int u = static_cast<int> (corner.x ()), v = static_cast<int> (corner.y ());
  double nearest = view.at (u, v);
  for (const float depth : {view.at (u, v), view.at (u + 1, v), view.at (u, v + 1), view.at (u + 1, v + 1)})
  {
    if (!std::isfinite (depth))
      return std::nullopt;
    nearest = std::min<double> (nearest, depth);
  }
  return nearest;
}

} // namespace

FreeSpaceViolation
measureFreeSpaceViolation (const std::vector<Eigen::Vector3d>& points, const std::vector<DepthView>& views,
                           double tolerance_m)
{
  if (!(tolerance_m >= 0.0 && std::isfinite (tolerance_m)))
    throw InvalidArgument ("tolerance_m must be a number of metres, 0 or more");
  for (const DepthView& view : views)
    view.validate ();
  FreeSpaceViolation result;
  std::size_t violating = 0;
  for (const Eigen::Vector3d& point : points)
  {
    bool seen = false;
    double depth_m = 0.0;
    for (const DepthView& view : views)
    {
      const Eigen::Vector3d p = view.T_world_sensor.inverse () * point;
      if (!(p.z () > 0.0))
        continue;
      if (const auto reading = nearestReading (view, view.camera.project (p)))
      {
        seen = true;
        depth_m = std::max (depth_m, *reading - p.z ());
      }
    }
    result.in_view += seen;
    if (depth_m <= tolerance_m)
      continue;
    ++violating;
    result.max_depth_m = std::max (result.max_depth_m, depth_m);
  }
  if (!points.empty ())
    result.share = static_cast<double> (violating) / static_cast<double> (points.size ());
  return result;
}

} // namespace pcl::cosection
