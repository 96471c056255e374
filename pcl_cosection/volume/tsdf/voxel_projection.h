// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief Part [begin, end) of a row of voxels along x. */
struct VoxelRange
{
  int begin = 0;
  int end = 0;
};

/** \brief Depth readings for VoxelProjection: one per pixel, row by row, and a last one for voxels without a pixel. */
struct DepthReadings
{
  static constexpr float none = -1e30f; ///< so far in front of every voxel that none learns from it

  std::vector<float> depth; ///< metres, or none
  float farthest_m = 0.0f;  ///< 0: no readings
};

/** \brief Where voxels are in a depth image, and how far in front of the surface, row by row along x. */
class VoxelProjection
{
public:
  /** \param[in] reach_m how far behind a reading voxels are of interest */
  VoxelProjection (const VoxelGrid& grid, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                   const DepthReadings& readings, double reach_m);

  /** \brief The voxels of a row that may be seen, up to one more at either end. */
  VoxelRange visible (int j, int k) const;

  /** \brief For each voxel of \a range, its pixel's index (width * height: none) and the distance along the ray from it
   * to the reading: metres, positive in front of the surface; DepthReadings::none without a reading. */
  void project (int j, int k, const VoxelRange& range, int* pixels, float* distances) const;

private:
  Eigen::Vector3d rowBegin (int j, int k) const { return T_sensor_grid_ * grid_.center (0, j, k); }

  const VoxelGrid& grid_;
  const PinholeCamera camera_;
  const DepthReadings& readings_;
  const Eigen::Isometry3d T_sensor_grid_;
  const Eigen::Vector3d step_; // from a voxel to the next of its row, sensor frame
  const double near_m_;        // nearer voxels are taken as beside the sensor
  const double far_m_;
};

} // namespace pcl::cosection
