// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run_folder.h"

#include <Eigen/Geometry>

/** \brief How an object was seen, in its own frame. */
struct ObjectDirections
{
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ ();
  Eigen::Vector3d front = Eigen::Vector3d (0.8, -1.0, 0.75).normalized (); ///< to the camera, in the mean
};

/** \brief Unit vectors, not along each other; the defaults where poses are missing. */
ObjectDirections directionsOf (const RunObject& object, const RunFolder& run, const Eigen::Vector3d& up);

/** \brief The pose at a stamp, to a millionth; null if there is no such pose. */
const Eigen::Isometry3d* poseAt (const std::vector<pcl::cosection::StampedPose>& poses, double stamp);

/** \brief Length, width and height (metres) of the smallest box around a mesh that stands vertical; zero without
 * vertices.
 * \param[in] up in the frame of the mesh, unit */
Eigen::Vector3d standingSize (const pcl::cosection::TriangleMesh& mesh, const Eigen::Vector3d& up);

/** \brief The middle of the box around a mesh. */
Eigen::Vector3d middleOf (const pcl::cosection::TriangleMesh& mesh);
