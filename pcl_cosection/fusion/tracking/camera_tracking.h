// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "brightness_tracking.h"
#include "camera_at_rest.h"
#include "pcl_cosection/fusion/fusion_setup.h"
#include "pcl_cosection/fusion/mapping/moving_parts.h"
#include "pcl_cosection/fusion/mapping/object_map.h"
#include "pcl_cosection/fusion/run_log.h"

#include <pcl/cosection/io/rgbd_sequence.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>

namespace pcl::cosection {

/** \brief What is known of the camera after a frame. */
struct CameraState
{
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity (); ///< the last accepted one
  Eigen::Isometry3d last_motion = Eigen::Isometry3d::Identity ();    ///< T_before_now of a frame
  std::size_t last_frame = 0;                                        ///< of the last accepted pose
  int frames_lost = 0;                                               ///< in a row
  bool only_objects = false; ///< nothing else had readings in the last frame, so that it was taken to rest
  MovingParts moving;        ///< of the frame of that pose
  RestReference rest;
  BrightnessReference brightness; ///< of the background
};

/** \brief The camera in one frame. */
struct CameraStep
{
  CameraState camera;
  bool tracked = false;
  double inlier_share = 0.0; ///< of the points that were aligned
};

/** \brief Track the camera against the background: points weighted by association, without moving parts, are aligned
 * with its volume.
 *
 * Only the part of the motion that is observed and significant is accepted (observedMotion ()), and none where pictures
 * show that the camera rests (decideRest ()). Brightness determines what the background's shape leaves open
 * (trackBrightness ()), and objects at rest what that leaves open (holdByRestingObjects ()). The camera begins from
 * where its last motion leads, then from where it was.
 * Where only objects have readings, as on turntables whose surroundings were cut away, nothing tells the motion of the
 * camera from theirs: it is taken to be at rest.
 * \param[in] mask null: none \param[in] background nothing: this is the first frame, which defines the world */
CameraStep trackCamera (const RgbdFrame& frame, const FrameCloud& cloud, const Image<std::uint16_t>* mask,
                        const std::optional<TsdfVolume>& background, const ObjectMap& objects, CameraState before,
                        const FusionSetup& setup, SdfAlignment& alignment, EventLog& log);

} // namespace pcl::cosection
