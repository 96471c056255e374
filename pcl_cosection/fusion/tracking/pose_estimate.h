// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "brightness_tracking.h"
#include "frame_cloud.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl::cosection {

constexpr int all_directions = 6; ///< of a pose

/** \brief How a frame agrees with a model's surface at a pose: numbers of surface points. */
struct Visibility
{
  /** \brief Share of the points that the frame confirms or contradicts; 0 without points. */
  double inViewShare () const { return facing > 0 ? static_cast<double> (confirmed + contradicted) / facing : 0.0; }

  /** \brief Share of these that it confirms; 1 without any. */
  double confirmedShare () const
  {
    const int seen = confirmed + contradicted;
    return seen > 0 ? static_cast<double> (confirmed) / seen : 1.0;
  }

  int facing = 0;       ///< the camera
  int confirmed = 0;    ///< of these: the reading is on the surface
  int contradicted = 0; ///< the reading is behind
};

/** \brief A model's pose relative to the camera, and whether to believe it. */
struct PoseEstimate
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  SdfAlignmentResult alignment;
  int observed_directions = 0;  ///< of six
  Visibility visibility;        ///< of objects
  TrackedPoints tracked;        ///< the points that were aligned
  std::string rejection_reason; ///< empty: the pose is accepted

  bool isAccepted () const { return rejection_reason.empty (); }
};

/** \brief Limits of a pose that is accepted. */
struct PoseLimits
{
  double max_shift_m;  ///< from the guess, of the points' centroid
  double max_turn_rad; ///< from the guess
  double min_inlier_share;
  double min_points_share; ///< of the points, those where the model knows a distance
};

/** \brief What poses are found with. */
struct PoseSolver
{
  const DataAssociation& association;
  SdfAlignment& alignment; ///< keeps nothing but its buffers from one use to the next
};

/** \brief Why a pose is rejected; empty if it is accepted.
 * \param[in] pose T_model_camera to be checked
 * \param[in] centre of the points, sensor frame
 * \param[in] points how many were aligned */
std::string rejectionReason (const SdfAlignmentResult& result, const Eigen::Isometry3d& pose,
                             const Eigen::Isometry3d& guess, const Eigen::Vector3d& centre, std::size_t points,
                             const PoseLimits& limits, double frames_passed);

/** \brief How many readings have the same error, as they are filtered together. */
double correlatedReadings (const PinholeCamera& camera);

/** \brief Weights of points times readingWeight (). */
std::vector<float> readingWeights (const std::vector<Eigen::Vector3f>& points, double voxel_size_m,
                                   std::vector<float> weights);

} // namespace pcl::cosection
