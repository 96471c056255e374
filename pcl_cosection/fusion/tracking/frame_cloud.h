// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief Smoothed brightness of a picture, 0 to 255, to be read between pixels. The first level has the picture's
 * size, each other one half the size of the one before. There are fewer levels if the picture is too small for all. */
using BrightnessLevels = std::vector<Image<float>>;

constexpr std::size_t brightness_levels = 3; ///< that tracking uses

/** \brief One label per pixel: the id of an object, 0: background or no reading, TrackedFrame::unassigned. */
using LabelImage = Image<std::uint16_t>;

/** \brief Labels by label or by instance. */
using LabelMap = std::map<std::uint16_t, std::uint16_t>;

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

  /** \brief The reliable points of a label. */
  std::vector<Eigen::Vector3f> pointsOf (const LabelImage& labels, std::uint16_t label) const;
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

/** \brief Brightness at a place within the image and how it changes per pixel. */
struct BrightnessReading
{
  float value;
  float du;
  float dv;
};

/** \brief Read between pixels. \param[in] pixel isWithin () an image of two pixels at least each way */
BrightnessReading readBrightness (const Image<float>& image, const Eigen::Vector2d& pixel);

bool isWithin (const Image<float>& image, const Eigen::Vector2d& pixel);

/** \brief Weight of a reading at depth \a z in a pose: the inverse of the variance of its distance to a model with
 * voxels of this size, in units of the model's own; 1 without noise. */
float readingWeight (double z, double voxel_size_m);

} // namespace pcl::cosection
