// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "half_spaces.h"

#include <limits>

namespace pcl::cosection {
std::vector<float>
HalfSpaces::beyond (const VoxelGrid& grid, int j, int k) const
{
  std::vector<float> values (static_cast<std::size_t> (grid.dims.x ()),
                             empty () ? 0.0f : -std::numeric_limits<float>::infinity ());
  const Eigen::Vector3d first = grid.center (0, j, k), step = grid.voxel_size_m * Eigen::Vector3d::UnitX ();
  for (const auto& [n, s] : sides_)
  {
    const auto at_first = static_cast<float> (n.dot (first) - s);
    const auto per_step = static_cast<float> (n.dot (step));
    for (std::size_t i = 0; i < values.size (); ++i)
    {
      const float value = at_first + static_cast<float> (i) * per_step;
      values[i] = values[i] < value ? value : values[i];
    }
  }
  return values;
}

} // namespace pcl::cosection
