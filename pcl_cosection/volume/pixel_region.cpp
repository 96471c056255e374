// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pixel_region.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection {

PixelRegion
wholeImage (const PinholeCamera& camera)
{
  return {0, 0, camera.width, camera.height};
}

PixelRegion
grown (const PixelRegion& region, int radius, const PinholeCamera& camera)
{
  return {std::max (0, region.left - radius), std::max (0, region.top - radius),
          std::min (camera.width, region.right + radius), std::min (camera.height, region.bottom + radius)};
}

PixelRegion
projectedRegion (const VoxelGrid& grid, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor)
{
  const Eigen::Isometry3d T_sensor_grid = T_grid_sensor.inverse ();
  Eigen::Vector2d low = Eigen::Vector2d::Constant (std::numeric_limits<double>::infinity ());
  Eigen::Vector2d high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d p = T_sensor_grid * grid.center ((corner & 1) ? grid.dims.x () - 1 : 0,
                                                           (corner & 2) ? grid.dims.y () - 1 : 0,
                                                           (corner & 4) ? grid.dims.z () - 1 : 0);
    if (!(p.z () > 0.0))
      return wholeImage (camera);
    low = low.cwiseMin (camera.project (p));
    high = high.cwiseMax (camera.project (p));
  }
  const Eigen::Vector2d size (camera.width, camera.height);
  const auto clipped = [&] (const Eigen::Vector2d& p) {
    return Eigen::Vector2i (p.cwiseMax (0.0).cwiseMin (size).cast<int> ());
  };
  const Eigen::Vector2i first = clipped (low.array ().floor ());
  const Eigen::Vector2i last = clipped (high.array ().ceil () + 1.0);
  return {first.x (), first.y (), last.x (), last.y ()};
}

} // namespace pcl::cosection
