// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"
#include "surface_samples.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief What is known of a pose, and how well. */
struct UncertainPose
{
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  Matrix6d precision = Matrix6d::Zero (); ///< inverse of the covariance of T_model_camera's left factor, in a chart's
                                          ///< coordinates, 1 / m^2

  /** \brief Of six, those in which it is known to about two millimetres. */
  int directions () const;
};

/** \brief Tells a model's pose by its brightness where its shape does not: along bare walls, about the axis of what is
 * round.
 *
 * Points of the model remember how bright they were in a frame. In another one they are projected to where a pose puts
 * them, and the pose is looked for that makes them as bright again, but for light that changes by one factor, one
 * offset and one slope for all, together with what the shape says of the pose, each in proportion to its precision, and
 * less where few readings of the shape tell: Gauss-Newton steps with Huber's weights, from coarse to fine images.
 * Points that are hidden there, by the depth, have no part. The frame that is compared with stays the same until much
 * of it is no longer seen, so that errors do not add up from frame to frame.
 *
 * As the photometric part of F. Steinbruecker, J. Sturm, D. Cremers, "Real-Time Visual Odometry from Dense RGB-D
 * Images", ICCV Workshops 2011. */
class BrightnessTracking
{
public:
  /** \brief Where brightness and shape together say that the model is; nothing where the shape says nothing at all,
   * where brightness tells of fewer than three directions, as it does of what has no pattern, or where it contradicts
   * itself.
   * \param[in] shape what the shape says, in the coordinates of \a chart
   * \param[in] guess T_model_camera, another pose to begin with */
  std::optional<UncertainPose> track (const FrameCloud& cloud, const MotionChart& chart, const UncertainPose& shape,
                                      const Eigen::Isometry3d& guess);

  /** \brief Remember a frame, if that is called for.
   * \param[in] points sensor frame, of pixels; \a probabilities: that they are the model's */
  void keep (const FrameCloud& cloud, const std::vector<Eigen::Vector3f>& points,
             const std::vector<float>& probabilities, const Eigen::Isometry3d& T_model_camera);

private:
  struct Point
  {
    Eigen::Vector3d position; // model frame
    std::array<float, brightness_levels> brightness;
  };

  /** \brief What the points say at a pose. */
  struct Sums;

  Sums compare (const FrameCloud& cloud, std::size_t level, const MotionChart& chart,
                const Eigen::Isometry3d& T_model_camera) const;

  std::vector<Point> points_;
  Eigen::Isometry3d T_model_camera_ = Eigen::Isometry3d::Identity (); // of the frame that is remembered
  double agreeing_ = 0.0; // share of the points that were as bright in the frame before
};

} // namespace pcl::cosection
