// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief Pixels of columns [left, right) and rows [top, bottom). */
struct PixelRegion
{
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/** \brief The whole image. */
PixelRegion wholeImage (const PinholeCamera& camera);

/** \brief A region and the pixels of the image around it, up to \a radius. */
PixelRegion grown (const PixelRegion& region, int radius, const PinholeCamera& camera);

/** \brief The pixels onto which a camera projects a grid; the whole image if the grid reaches behind the camera. */
PixelRegion projectedRegion (const VoxelGrid& grid, const PinholeCamera& camera,
                             const Eigen::Isometry3d& T_grid_sensor);

} // namespace pcl::cosection
