// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_cloud.h"
#include "pcl_cosection/fusion/mapping/moving_parts.h"

#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief The frame with which later ones are compared to find out whether the camera has moved. */
struct RestReference
{
  Image<float> depth;      ///< metres; empty: there is no frame yet
  Image<float> brightness; ///< smoothed; empty without colour
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity ();
  double unexplained = 0.0; ///< usual sum of squares of the differences that a pose leaves, in standard deviations
  bool rested = true;       ///< the camera, in the frame before
};

/** \brief Whether the camera has moved since the reference. */
struct RestDecision
{
  bool at_rest = false;     ///< it is still at the reference's pose
  bool rests = true;        ///< what is believed from now on; it stays as it was where nothing is certain
  bool moved = true;        ///< enough for another reference
  double unexplained = 0.0; ///< sum of squares of the differences, of the pose that is believed
};

/** \brief Tell a camera that moves from one before which something moves, by pictures.
 *
 * A frame is compared with the reference, brightness and depth, twice: pixel by pixel, as if the camera had not moved,
 * and where an estimate of its motion puts the pixels. A block of the image votes for one of the two if that one
 * explains the block up to noise and the other clearly does not; a sector of the image has such blocks or not. Only
 * brightness votes for rest: depth stays the same where the camera slides along smooth surfaces. While the camera
 * moves, no sector votes for rest, or one by chance; things that move by themselves may be in many sectors. So a camera
 * that rested is believed to rest unless several times more sectors vote for motion than for rest, or unless no sector
 * votes and motion explains the image better; it begins to move when hardly any sector votes for rest. A camera that
 * moved is believed to rest only if that explains the image as well as usual: the better of two wrong answers is still
 * wrong.
 * \param[in] T_world_camera by which the camera would have moved
 * \param[in] moving pixels that do not vote for motion */
RestDecision decideRest (const RestReference& reference, const Eigen::Isometry3d& T_world_camera,
                         const FrameCloud& cloud, const MovingParts& moving);

/** \brief The reference for the next frame: this one, if the camera has moved. */
RestReference nextReference (RestReference reference, const RestDecision& decision, const FrameCloud& cloud,
                             const Eigen::Isometry3d& T_world_camera);

} // namespace pcl::cosection
