// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "measured_surface.h"

#include "pcl_cosection/common/cell_key.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr float same_side = 0.5f; // cosine between normals

} // namespace

MeasuredSurface::MeasuredSurface (const std::vector<OrientedPoint>& points, double voxel_size_m)
    : points_ (points)
    , voxel_size_m_ (voxel_size_m)
{
  for (std::size_t n = 0; n < points.size (); ++n)
    if (const auto cell = cellOf (points[n].position.cast<double> () / (voxels_deep * voxel_size_m)))
      cells_[keyOf (*cell)].push_back (static_cast<std::uint32_t> (n));
}

bool
MeasuredSurface::has (const OrientedPoint& point, double depth_vox) const
{
  const auto place = cellOf (point.position.cast<double> () / (voxels_deep * voxel_size_m_));
  if (!place)
    return false;
  const auto deepest = static_cast<float> (-depth_vox * voxel_size_m_);
  const auto beside = static_cast<float> (voxels_beside * voxel_size_m_);
  const auto isBeside = [&] (std::uint32_t n) {
    const OrientedPoint& own = points_[n];
    const Eigen::Vector3f way = point.position - own.position;
    const float height = own.normal.dot (way);
    return height > deepest && height < beside && way.squaredNorm () - height * height < beside * beside &&
           own.normal.dot (point.normal) > same_side;
  };
  for (int k = 0; k < 27; ++k)
  {
    const auto cell = cells_.find (keyOf (neighbourOf (*place, k)));
    if (cell != cells_.end () && std::any_of (cell->second.begin (), cell->second.end (), isBeside))
      return true;
  }
  return false;
}

} // namespace pcl::cosection
