// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "brightness_image.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief The readings of a depth image as points, row by row. */
struct FrameCloud
{
  PinholeCamera camera;
  Image<float> depth;                  ///< metres; NaN: no reading, or beyond the largest depth
  Image<float> reliable;               ///< the same without pixels at depth edges, where pixels are mixed
  std::vector<Eigen::Vector3f> points; ///< sensor frame, one per pixel, from filtered depth if asked for; NaN: no point
  std::size_t readings = 0;
  BrightnessLevels brightness; ///< of the same pixels; empty without colour
  /** \brief Not 0: the first level's brightness is that of one surface alone, by the depth. Empty without colour. */
  Image<std::uint8_t> unmixed;

  /** \brief Every \a step-th reliable point along rows and columns. */
  std::vector<Eigen::Vector3f> sample (int step) const;
};

/** \brief A frame whose camera is known. */
struct PosedFrame
{
  double stamp;
  const FrameCloud& cloud;
  Eigen::Isometry3d T_world_camera;
};

/** \brief Turn a depth image into points, after a bilateral filter if asked for; depth and reliable stay as read.
 * \throws InvalidArgument if the depth image has not the camera's size */
FrameCloud makeFrameCloud (const RgbdFrame& frame, const PinholeCamera& camera, const DynamicFusionOptions& options);

/** \brief Weight of a reading at depth \a z in a pose: the inverse of the variance of its distance to a model with
 * voxels of this size, in units of the model's own; 1 without noise. */
float readingWeight (double z, double voxel_size_m);

} // namespace pcl::cosection
