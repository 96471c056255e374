// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "brightness_image.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief The readings of a depth image as points, row by row. */
struct FrameCloud
{
  PinholeCamera camera;
  Image<float> depth;                  ///< metres; NaN: no reading, beyond the largest depth
  Image<float> reliable;               ///< the same without pixels at depth edges, where readings are frayed
  std::vector<Eigen::Vector3f> points; ///< sensor frame, of all readings, smoothed if asked for; NaN: none
  std::size_t readings = 0;
  BrightnessLevels brightness; ///< of the same pixels; none without colours
  Image<std::uint8_t>
      unmixed; ///< not 0 where the first level's brightness is of one surface alone, by the depth; none without colours

  /** \brief Every \a step-th reliable point along rows and columns. */
  std::vector<Eigen::Vector3f> sample (int step) const;
};

/** \param[in] smooth filter the points' depth bilaterally */
FrameCloud makeFrameCloud (const Image<float>& depth, const PinholeCamera& camera, double max_depth_m, bool smooth,
                           int threads);

/** \brief Look at the colours, too. \param[in] colour of the depth's size */
void addBrightness (const Picture& colour, FrameCloud& cloud);

/** \brief How much a reading at depth \a z counts for a pose: the inverse of its variance, with that of a model whose
 * voxels are so large; 1 without noise. */
float readingWeight (double z, double voxel_size_m);

} // namespace pcl::cosection
