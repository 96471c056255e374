// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_cloud.h"
#include "observed_motion.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A pose and how well it is known. */
struct UncertainPose
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  /** \brief Inverse of the covariance of T_model_camera's left factor, in a chart's coordinates, 1 / m^2. */
  Matrix6d precision = Matrix6d::Zero ();

  /** \brief Of six, the directions in which it is known to about two millimetres. */
  int directions () const;
};

/** \brief Points of a model and how bright they were in a frame. */
struct BrightnessReference
{
  struct Point
  {
    Eigen::Vector3d position; ///< model frame
    std::array<float, brightness_levels> brightness;
  };

  std::vector<Point> points;
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity (); ///< of the frame
};

/** \brief The points of a frame that a model was tracked with. */
struct TrackedPoints
{
  std::vector<Eigen::Vector3f> points; ///< sensor frame
  std::vector<float> probabilities;    ///< of being the model's and, for the background, at rest
  double brightness_agreement = 0.0;   ///< share of the reference's points that are as bright as in the reference
};

/** \brief The pose that brightness and shape together determine. */
struct BrightnessFit
{
  std::optional<UncertainPose> pose; ///< nothing: brightness says nothing
  double agreement = 0.0;            ///< TrackedPoints::brightness_agreement
};

/** \brief Find a model's pose by its brightness where its shape leaves it open: along bare walls, about the axis of
 * round things.
 *
 * The points of the reference are projected into the frame. The pose makes them as bright as in the reference, but for
 * light that changes by one factor, one offset and one slope for all, and stays near the pose of the shape, each in
 * proportion to its precision, and to the shape less along directions that few readings observe: Gauss-Newton steps
 * with Huber's weights, from coarse to fine images. Points that are occluded, by the depth, are left out. The reference
 * stays the same until much of it is no longer seen, so that errors do not add up from frame to frame.
 *
 * The pose is nothing where the shape says nothing at all, where brightness observes fewer than three directions, as of
 * things without texture, or where few points agree with it. As the photometric part of F. Steinbruecker, J. Sturm,
 * D. Cremers, "Real-Time Visual Odometry from Dense RGB-D Images", ICCV Workshops 2011.
 * \param[in] chart coordinates of the precisions
 * \param[in] shape pose by the shape alone
 * \param[in] guess T_model_camera, another pose to begin with */
BrightnessFit trackBrightness (const BrightnessReference& reference, const FrameCloud& cloud, const MotionChart& chart,
                               const UncertainPose& shape, const Eigen::Isometry3d& guess);

/** \brief The reference for the next frame: this one, if the other is worn out. \param[in] tracked with which the model
 * was tracked in this frame */
BrightnessReference nextReference (BrightnessReference reference, const FrameCloud& cloud, const TrackedPoints& tracked,
                                   const Eigen::Isometry3d& T_model_camera);

} // namespace pcl::cosection
