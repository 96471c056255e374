// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstddef>

namespace pcl::cosection {

/** \brief A voxel whose centre a camera sees in its image. */
struct ProjectedVoxel
{
  std::size_t index;
  double z;          ///< along the optical axis, metres
  double u, v;       ///< continuous pixel
  int column, row;   ///< the pixel it falls into
  std::size_t pixel; ///< index of that
};

/** \brief Call \a f (ProjectedVoxel) for every voxel in front of the camera and inside its image. Planes of
 * voxels go to several threads. */
template <typename Function>
void
forEachProjectedVoxel (const VoxelGrid& grid, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                       int threads, Function&& f)
{
  const Eigen::Isometry3d T_sensor_grid = T_grid_sensor.inverse ();
  const Eigen::Vector3d step = T_sensor_grid.linear ().col (0) * grid.voxel_size_m;
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const Eigen::Vector3d start = T_sensor_grid * grid.center (0, j, k);
      ProjectedVoxel voxel;
      voxel.index = grid.index (0, j, k);
      for (int i = 0; i < grid.dims.x (); ++i, ++voxel.index)
      {
        const Eigen::Vector3d p = start + i * step;
        if (p.z () <= 0.0)
          continue;
        const double inverse = 1.0 / p.z ();
        voxel.z = p.z ();
        voxel.u = camera.fx * p.x () * inverse + camera.cx;
        voxel.v = camera.fy * p.y () * inverse + camera.cy;
        if (!(voxel.u >= -0.5 && voxel.v >= -0.5 && voxel.u < camera.width - 0.5 && voxel.v < camera.height - 0.5))
          continue;
        voxel.column = static_cast<int> (voxel.u + 0.5);
        voxel.row = static_cast<int> (voxel.v + 0.5);
        voxel.pixel = static_cast<std::size_t> (voxel.row) * camera.width + voxel.column;
        f (const_cast<const ProjectedVoxel&> (voxel));
      }
    }
  });
}

} // namespace pcl::cosection
