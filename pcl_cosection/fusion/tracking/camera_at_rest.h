// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"
#include "pcl_cosection/fusion/mapping/moving_parts.h"

#include <pcl/cosection/common/image.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief Tells a camera that moves from one before which something moves, by pictures.
 *
 * A frame is compared with one before it, brightness and depth, twice: pixel by pixel, as if the camera had not moved,
 * and by where an estimate of its motion puts them. A block of the image tells where one of them explains it up to the
 * noise and the other plainly does not; a sector of the image has such blocks or not. For rest, brightness tells: depth
 * is the same where one slides along smooth surfaces. What rests as the camera does is in no sector while the camera
 * moves, or in one by chance; what moves by itself may be in many. So a camera that rested goes on resting unless
 * motion is in some times more sectors than rest, or where no sectors tell and motion explains the image worse; it
 * begins to move when rest is hardly anywhere. One that moved rests only if that explains the image up to what is
 * usual: of two wrong answers, the better one is wrong, too. */
class CameraAtRest
{
public:
  /** \brief Begin to look at a frame. */
  void begin (const FrameCloud& cloud);

  /** \brief Whether the camera is still at T_world_camera (), rather than at \a T_world_camera.
   * \param[in] moving what does not say that it moved */
  bool isPreferredTo (const Eigen::Isometry3d& T_world_camera, const FrameCloud& cloud, const MovingParts& moving);

  /** \brief Compare what follows with this frame, unless the camera is still about where it was when the present one
   * was seen. */
  void keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera);

  /** \brief Where the camera was in the frame that others are compared with. */
  const Eigen::Isometry3d& T_world_camera () const { return T_world_camera_; }

private:
  /** \brief Sums of squares of differences, in standard deviations, if the camera has not moved and if it has. */
  struct Comparison
  {
    double at_rest = 0.0;
    double moved = 0.0;

    void add (float rest_sigmas, float motion_sigmas);
  };

  /** \brief What a block of the image says. */
  struct Ballot
  {
    Comparison brightness, depth;
    int of_background = 0; // pixels, less those of what moves by itself
  };

  bool coloured () const { return !brightness_.pixels.empty () && !now_.pixels.empty (); }

  /** \brief Row by row. \param[out] mean_shift_px from where pixels were to where the motion puts them */
  std::vector<Ballot> compareBlocks (const FrameCloud& cloud, const Eigen::Isometry3d& T_now_then,
                                     const MovingParts& moving, double& mean_shift_px) const;

  Image<float> depth_;      // of the frame that others are compared with
  Image<float> brightness_; // smoothed; empty without colours
  Image<float> now_;        // brightness of the frame that is looked at
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity ();
  double unexplained_ = 0.0;     // sum of squares of the frames before, as they were believed: about that of noise
  double unexplained_now_ = 0.0; // of the one that is looked at
  bool rested_ = true;           // in the frame before
  bool rests_ = true;            // in the one that is looked at
  bool moved_ = true;            // since the one that others are compared with
};

} // namespace pcl::cosection
