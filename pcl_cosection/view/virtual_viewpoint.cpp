// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "virtual_viewpoint.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/sphere_directions.h"

#include "pcl_cosection/view/range_image.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int directions = 400;
constexpr std::size_t samples = 2000;
constexpr double unsure_share = 0.1; // of the points, may face away from the sensor, or be hidden from it
constexpr double distance_diagonals = 5.0;

} // namespace

std::optional<DepthView>
virtualViewpoint (const std::vector<OrientedPoint>& points)
{
  if (points.empty ())
    return std::nullopt;
  const std::size_t step = std::max<std::size_t> (1, points.size () / samples);
  std::vector<float> cosines;
  float best = 0.0f;
  Eigen::Vector3f facing = Eigen::Vector3f::Zero ();
  for (int n = 0; n < directions; ++n)
  {
    const Eigen::Vector3f d = sphereDirection (n, directions);
    cosines.clear ();
    for (std::size_t p = 0; p < points.size (); p += step)
      if (points[p].normal.allFinite ())
        cosines.push_back (d.dot (points[p].normal));
    if (cosines.empty ())
      return std::nullopt;
    if (const float low = trimmedMin (cosines, unsure_share); low > best)
    {
      best = low;
      facing = d;
    }
  }
  if (!(best > 0.0f))
    return std::nullopt;
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3f> positions;
  positions.reserve (points.size ());
  for (const OrientedPoint& p : points)
  {
    positions.push_back (p.position);
    box.extend (p.position.cast<double> ());
  }
  std::optional<RangeImage> image = drawRangeImage (
      positions, box.center () + distance_diagonals * box.diagonal ().norm () * facing.cast<double> ());
  if (!image || image->hidden_share > unsure_share)
    return std::nullopt;
  return std::move (image->view);
}

} // namespace pcl::cosection
