// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief What moves in the images and belongs to no object that is known: hands, people, things that no mask has
 * shown.
 *
 * Log odds of being at rest, on a grid of pixels, from frame to frame. With the distance of a reading to the background
 * in units of its standard deviation, averaged over the surface around it, z, they change by
 *
 *     log (p (z | at rest) / p (z | moving)),   p (z | at rest): normal,  p (z | moving): uniform
 *
 * and go with the surface to its next image. Motion shows at once; rest only in time. What is in space that the
 * background has seen free moves. Where more than a quarter of what is seen does not fit, it is the background's model
 * or pose that errs: the standard deviation grows. */
class MovingParts
{
public:
  /** \brief Carry over what the frames before said. \param[in] T_world_camera where the camera may be */
  void begin (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  /** \brief Add what this frame says. \param[in] models the background first, objects relative to the camera at \a
   * T_world_camera */
  void look (const FrameCloud& cloud, const std::vector<AssociatedModel>& models, const DataAssociation& association,
             const Eigen::Isometry3d& T_world_camera);

  /** \brief Let the next frame begin with what was found. */
  void keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  /** \brief Take what a mask says for moving, in the next frames too. \param[in] ignored label of it */
  void ignore (const FrameCloud& cloud, const Image<std::uint16_t>& mask, std::uint16_t ignored,
               const Eigen::Isometry3d& T_world_camera);

  /** \brief Multiply weights of points by their probability to be at rest.
   * \return what share of the weights was lost */
  double weigh (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points,
                std::vector<float>& weights) const;

  /** \brief Give pixels of label 0 that move another one. */
  void mark (const FrameCloud& cloud, Image<std::uint16_t>& labels, std::uint16_t moving) const;

  /** \brief 1 where pixels of label 0 or \a unassigned move, else 0. */
  Image<std::uint8_t> image (const FrameCloud& cloud, const Image<std::uint16_t>& labels,
                             std::uint16_t unassigned) const;

  bool any () const { return any_; }

  /** \brief Whether the pixel shows something that moves. */
  bool moves (int u, int v) const;

private:
  /** \brief The reading of a node, sensor frame. */
  const Eigen::Vector3f& pointAt (const FrameCloud& cloud, int i, int j) const;

  int step_ = 1; // pixels from one node to the next
  bool any_ = false;
  Image<float> carried_; // log odds; NaN: no reading
  Image<float> log_odds_;
  Image<float> last_; // of the frame before
  Image<float> last_depth_;
  Eigen::Isometry3d T_world_last_ = Eigen::Isometry3d::Identity ();
};

} // namespace pcl::cosection
