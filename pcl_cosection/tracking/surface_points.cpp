// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/tracking/surface_points.h>

#include <cmath>

namespace pcl
{
namespace cosection
{

std::vector<Eigen::Vector3f>
surfacePoints (const SignedDistanceField& field)
{
  const VoxelGrid& grid = field.grid;
  const auto known = [&field] (std::size_t v) {
    return std::isfinite (field.values[v]) && (field.supported.empty () || field.supported[v]);
  };
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t begin = grid.index (i, j, k);
        if (!known (begin))
          continue;
        for (int axis = 0; axis < 3; ++axis)
        {
          const Eigen::Vector3i neighbour = Eigen::Vector3i (i, j, k) + Eigen::Vector3i::Unit (axis);
          if (!grid.contains (neighbour.x (), neighbour.y (), neighbour.z ()))
            continue;
          const std::size_t end = grid.index (neighbour.x (), neighbour.y (), neighbour.z ());
          const float a = field.values[begin];
          const float b = field.values[end];
          if (!known (end) || (a < 0.0f) == (b < 0.0f))
            continue;
          Eigen::Vector3d p = grid.center (i, j, k);
          p[axis] += grid.voxel_size_m * (a / (a - b));
          points.push_back (p.cast<float> ());
        }
      }
  return points;
}

} // namespace cosection
} // namespace pcl
