// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"

#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

namespace pcl
{
namespace cosection
{

/** \brief Tells a camera that moves from one before which something moves, by pictures.
 *
 * A frame is compared with one before it, brightness and depth, twice: pixel by pixel, as if the camera had not moved, and by where an estimate of
 * its motion puts them. Each sector of the image votes for what explains more of its blocks better, where the difference is plain: what moves by
 * itself is in few sectors, edges and texture of what rests in many. Without a plain majority, the camera goes on as it did: resting or moving. */
class CameraAtRest
{
public:
  /** \brief Begin to look at a frame. */
  void
  begin (const FrameCloud& cloud, const Picture& colour);

  /** \brief Whether the camera is still at T_world_camera (), rather than at \a T_world_camera. */
  bool
  isPreferredTo (const Eigen::Isometry3d& T_world_camera, const FrameCloud& cloud);

  /** \brief Compare what follows with this frame, unless the camera is still about where it was when the present one was seen. */
  void
  keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  /** \brief Where the camera was in the frame that others are compared with. */
  const Eigen::Isometry3d&
  T_world_camera () const
  {
    return T_world_camera_;
  }

private:
  Image<float> depth_;      // of the frame that others are compared with
  Image<float> brightness_; // smoothed; empty without colours
  Image<float> now_;        // brightness of the frame that is looked at
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity ();
  bool rested_ = true; // in the frame before
  bool rests_ = true;  // in the one that is looked at
  bool moved_ = true;  // since the one that others are compared with
};

} // namespace cosection
} // namespace pcl
