// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "brightness_tracking.h"
#include "frame_cloud.h"
#include "visibility_check.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl::cosection
{

constexpr int all_directions = 6; ///< of a pose

/** \brief Where a model is relative to the camera, and whether to believe it. */
struct PoseEstimate
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  SdfAlignmentResult alignment;
  int observed_directions = 0; ///< of six, those that the surface tells
  Visibility visibility;       ///< of objects
  std::string doubt;           ///< why it is not believed; empty: it is
};

/** \brief What a pose is checked against. */
struct PoseLimits
{
  double max_shift_m;  ///< from the guess, of the points' centroid
  double max_turn_rad; ///< from the guess
  double min_inlier_share;
  double min_points_share; ///< of the points, those where the model knows a distance
};

/** \brief How poses are looked for from frame to frame. */
SdfAlignmentOptions trackingOptions (int max_points, int threads);

/** \brief Why a pose is not believed; empty if it is.
 * \param[in] pose T_model_camera, what of \a result is meant
 * \param[in] centre of what is tracked, sensor frame
 * \param[in] points how many there are */
std::string doubtOf (const SdfAlignmentResult& result, const Eigen::Isometry3d& pose, const Eigen::Isometry3d& guess,
                     const Eigen::Vector3d& centre, std::size_t points, const PoseLimits& limits, double frames_passed);

/** \brief How many readings of neighbouring pixels err together, as they are filtered together. */
double correlatedReadings (const PinholeCamera& camera);

/** \brief Multiply weights of points by that of their readings. */
void weighReadings (const std::vector<Eigen::Vector3f>& points, double voxel_size_m, std::vector<float>& weights);

/** \brief Tracks objects relative to the camera: frame to model, weighted by association, by their shape and their
 * brightness. */
class PoseTracking
{
public:
  PoseTracking (int max_points, const AssociationOptions& association, int threads);

  /** \brief Track the model of number \a target from where it is among \a models. \param[in,out] brightness of that
   * model */
  PoseEstimate trackObject (const FrameCloud& cloud, std::vector<AssociatedModel> models, std::size_t target,
                            double frames_passed, BrightnessTracking& brightness);

  /** \brief Believe where the object that was tracked last is: it may be compared with this frame later. */
  void keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_model_camera, BrightnessTracking& brightness) const
  {
    brightness.keep (cloud, points_, probabilities_, T_model_camera);
  }

  /** \brief Find an object at points of which all are said to be its own. \param[in] guess T_model_camera */
  PoseEstimate findObject (const FrameCloud& cloud, const std::vector<Eigen::Vector3f>& points,
                           const TsdfVolume& volume, const Eigen::Isometry3d& guess);

private:
  SdfAlignment object_;
  DataAssociation association_;
  std::vector<Eigen::Vector3f> points_; // of the object that was tracked last, sensor frame
  std::vector<float> probabilities_;    // that they are its own
};

} // namespace pcl::cosection
