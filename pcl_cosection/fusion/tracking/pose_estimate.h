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

/** \brief How a frame agrees with a model's surface at a pose: numbers of surface points that face the camera. */
struct Visibility
{
  std::size_t outside = 0;      ///< of the image
  std::size_t unread = 0;       ///< where there is no reading
  std::size_t occluded = 0;     ///< something is in front
  std::size_t confirmed = 0;    ///< the reading is on the surface
  std::size_t contradicted = 0; ///< the reading is behind

  std::size_t facing () const { return outside + unread + occluded + confirmed + contradicted; }

  /** \brief Share of the points that the frame confirms or contradicts; 0 without points. */
  double inViewShare () const;

  /** \brief Share of these that it confirms; 1 without any. */
  double confirmedShare () const;
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
