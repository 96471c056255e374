// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>

namespace pcl::cosection
{

/** \brief What a frame says of a model's surface at a pose: points of the surface that face the camera, counted. */
struct Visibility
{
  std::size_t outside = 0;      ///< of the image
  std::size_t unread = 0;       ///< where there is no reading
  std::size_t occluded = 0;     ///< something is in front
  std::size_t confirmed = 0;    ///< the reading is on the surface
  std::size_t contradicted = 0; ///< the reading is behind

  std::size_t facing () const { return outside + unread + occluded + confirmed + contradicted; }

  /** \brief Share of the points about which the frame says something; 0 without points. */
  double inViewShare () const;

  /** \brief Share of those that is confirmed; 1 if it says nothing. */
  double confirmedShare () const;
};

/** \param[in] tolerance_m how far a reading may be from the surface, beside three standard deviations of its noise */
Visibility checkVisibility (const TsdfVolume& volume, const Eigen::Isometry3d& T_model_camera, const FrameCloud& cloud,
                            double tolerance_m);

} // namespace pcl::cosection
