// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief What moves in an image and belongs to no known object: hands, people, things that no mask has shown.
 *
 * Log odds of being at rest, on a grid of pixels. With z the distance of a reading to the background in units of its
 * standard deviation, averaged over the surface around it, a frame changes them by
 *
 *     log (p (z | at rest) / p (z | moving)),   p (z | at rest): normal,  p (z | moving): uniform
 *
 * They go with the surface to its next image. Motion shows at once, rest only over time. What is in space that the
 * background has observed to be free moves. Where more than a quarter of the readings do not fit, the background's
 * model or pose is wrong, and the standard deviation grows. */
struct MovingParts
{
  int step = 1;          ///< pixels from one node to the next
  Image<float> log_odds; ///< one per node, negative: moving, NaN: no reading; empty before the second frame
  Image<float> depth;    ///< of the nodes, metres
  bool any = false;      ///< whether any node moves
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity (); ///< of the frame

  /** \brief Whether the pixel shows something that moves. */
  bool moves (int u, int v) const;
};

/** \brief What a frame before says of this one. \param[in] T_world_camera where the camera may be */
MovingParts carryOver (const MovingParts& before, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

/** \brief Add what a frame shows. \param[in] models the background first, objects where they are expected
 * \param[in] T_world_camera of this frame */
MovingParts observeMotion (const MovingParts& carried, const FrameCloud& cloud,
                           const std::vector<AssociatedModel>& models, const DataAssociation& association,
                           const Eigen::Isometry3d& T_world_camera);

/** \brief Take pixels that a mask labels FrameSegmenter::ignored for moving, in the next frames too. */
MovingParts withIgnored (MovingParts moving, const FrameCloud& cloud, const Image<std::uint16_t>& mask,
                         const Eigen::Isometry3d& T_world_camera);

/** \brief Weights of points, multiplied by their probability to be at rest. */
struct RestingWeights
{
  std::vector<float> weights;
  double moving_share = 0.0; ///< share of the weight that was lost
};

RestingWeights restingWeights (const MovingParts& moving, const PinholeCamera& camera,
                               const std::vector<Eigen::Vector3f>& points, std::vector<float> weights);

/** \brief 1 where a pixel of label 0 or TrackedFrame::unassigned moves, else 0. */
Image<std::uint8_t> movingPixels (const MovingParts& moving, const FrameCloud& cloud,
                                  const Image<std::uint16_t>& labels);

} // namespace pcl::cosection
