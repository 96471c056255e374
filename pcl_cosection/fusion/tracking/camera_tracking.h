// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "brightness_tracking.h"
#include "camera_at_rest.h"
#include "pcl_cosection/fusion/mapping/moving_parts.h"
#include "pcl_cosection/fusion/mapping/tracked_object.h"
#include "pose_tracking.h"

#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief Tracks the camera against the background: frame to model, weighted by association, without what moves.
 *
 * Of the motion that is found, only what is observed and significant is believed (see observedMotion ()); and none
 * where pictures say plainly that the camera rests (see CameraAtRest). What the background's shape leaves open, its
 * brightness tells (see BrightnessTracking); and what that leaves open, objects at rest may tell (see
 * holdByRestingObjects ()). */
class CameraTracking
{
public:
  CameraTracking (int max_points, const AssociationOptions& association, int threads);

  /** \brief Begin to look at a frame. */
  void begin (const FrameCloud& cloud);

  /** \brief Where the camera is in that frame.
   * \param[in] models the background first, objects where they are expected relative to the camera at \a guess
   * \param[in] objects of those models
   * \param[in] guess T_world_camera */
  PoseEstimate track (const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
                      const std::vector<TrackedObject*>& objects, const Eigen::Isometry3d& guess, double frames_passed);

  /** \brief Believe where the camera is in that frame: the next ones are compared with it. */
  void keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  /** \brief Do not track with what a mask of that frame labels as \a ignored. */
  void ignore (const FrameCloud& cloud, const Image<std::uint16_t>& mask, std::uint16_t ignored,
               const Eigen::Isometry3d& T_world_camera)
  {
    moving_.ignore (cloud, mask, ignored, T_world_camera);
  }

  /** \brief Of the frame that was tracked last. */
  const MovingParts& moving () const { return moving_; }

private:
  SdfAlignment alignment_;
  DataAssociation association_;
  MovingParts moving_;
  CameraAtRest at_rest_;
  BrightnessTracking brightness_;
  std::vector<Eigen::Vector3f> points_;                       // that were tracked last
  std::vector<float> of_background_;                          // their probabilities to be of the background and at rest
  Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity (); // T_world_camera
  int max_points_;
};

} // namespace pcl::cosection
