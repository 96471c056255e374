// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <Eigen/Core>

#include <cstdint>

namespace pcl::cosection
{

/** \brief What a structured-light camera makes of the true depth.
 *
 * Such a camera measures the disparity d = fx B / z between its picture and that of its projector: an error of s pixels
 * is one of z^2 / (fx B) s in depth. Where a depth is read varies by a fraction of a pixel, and there is none where the
 * pattern is seen too flat, torn by an edge, or not at all because something else stands in the projector's light.
 * After K. Khoshelham and S. O. Elberink, "Accuracy and resolution of Kinect depth data", Sensors 2012, C. V. Nguyen et
 * al., "Modeling Kinect sensor noise", 3DIMPVT 2012, and A. Handa et al., "A benchmark for RGB-D visual odometry", ICRA
 * 2014. */
struct PCL_COSECTION_EXPORT DepthNoise
{
  double baseline_m = 0.075;        ///< from the camera to the projector, which is on its right
  double disparity_sigma_px = 0.06; ///< standard deviation
  double disparity_step_px = 0.125; ///< disparities are multiples of it; 0: of nothing
  double lateral_sigma_px = 0.5;    ///< of where a depth is read, each way
  double grazing_begin_rad = 1.31;  ///< angle between ray and normal from which on readings fail ...
  double grazing_end_rad = 1.51;    ///< ... and at which all do
  double edge_dropout = 0.4;        ///< probability that a reading at a depth edge fails
  double edge_step = 0.03;          ///< a depth edge is a step of more than this fraction of the depth
  double dropout = 0.002;           ///< probability that any reading fails
  double min_m = 0.3;               ///< nearest depth
  double max_m = 8.0;               ///< farthest depth
  bool shadows = true;              ///< of the projector's light

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Depth as the camera measures it. The result depends on \a seed and \a frame, not on threads.
 * \param[in] depth metres along the optical axis, NaN: nothing there
 * \param[in] normals unit, sensor frame, one per pixel
 * \return metres, NaN: no reading */
PCL_COSECTION_EXPORT Image<float> measureDepth (const Image<float>& depth, const std::vector<Eigen::Vector3f>& normals,
                                                const PinholeCamera& camera, const DepthNoise& noise,
                                                std::uint64_t seed, std::uint64_t frame);

} // namespace pcl::cosection
