// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>

namespace pcl::cosection
{

/** \brief How a frame agrees with a model's surface at a pose: numbers of surface points that face the camera. */
struct Visibility
{
  std::size_t outside = 0;      ///< of the image
  std::size_t unread = 0;       ///< where there is no reading
  std::size_t occluded = 0;     ///< something is in front
  std::size_t confirmed = 0;    ///< the reading is on the surface
  std::size_t contradicted = 0; ///< the reading is behind

  std::size_t facing () const { return outside + unread + occluded + confirmed + contradicted; }

  /** \brief Share of the points that the frame confirms or contradicts; 0 without points. */
  double inViewShare () const;

  /** \brief Share of these that it confirms; 1 without any. */
  double confirmedShare () const;
};

/** \brief Compare a model's surface points with the readings of their pixels.
 * \param[in] tolerance_m how far a reading may be from the surface, beside three standard deviations of its noise */
Visibility checkVisibility (const TsdfVolume& volume, const Eigen::Isometry3d& T_model_camera, const FrameCloud& cloud,
                            double tolerance_m);

} // namespace pcl::cosection
