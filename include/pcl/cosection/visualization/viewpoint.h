// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <Eigen/Geometry>

#include <string>

namespace pcl::cosection
{

/** \brief From where a scene is looked at. */
struct PCL_COSECTION_EXPORT Viewpoint
{
  Eigen::Vector3d eye = {0.0, 0.0, -2.0};   ///< metres, world frame
  Eigen::Vector3d target = {0.0, 0.0, 0.0}; ///< in the middle of the picture, metres
  Eigen::Vector3d up = {0.0, -1.0, 0.0};    ///< points up in the picture; not along the line of sight
  double angle_rad = 0.7;                   ///< between the upper and the lower edge of the picture

  /** \brief T_world_camera, z forward, y down. */
  Eigen::Isometry3d pose () const;

  /** \brief The camera of a picture of this size. */
  PinholeCamera camera (int width, int height) const;

  /** \brief \throws InvalidArgument if something is not finite, there is no line of sight, \a up is along it, or the
   * angle is outside (0, pi) */
  void validate () const;
};

/** \brief What is above in a scene: where its floor or table faces, among what is above in the pictures; those alone
 * where there is none. Unit. */
PCL_COSECTION_EXPORT Eigen::Vector3d upDirection (const RunScene& scene);

/** \brief From above and behind the cameras, with all objects in the picture, wherever they were; of a scene without
 * objects, with the background.
 * \param[in] turn_rad go around the middle of what is to be seen; with pi, one sees what the cameras did not */
PCL_COSECTION_EXPORT Viewpoint overview (const RunScene& scene, double turn_rad = 0.0);

/** \brief A camera of \a width x \a height pixels that sees all that \a camera sees, and more to the sides or above and
 * below where the pictures have other proportions. */
PCL_COSECTION_EXPORT PinholeCamera fittedCamera (const PinholeCamera& camera, int width, int height);

/** \brief Write a viewpoint as JSON: eye, target, up, angle_deg. \throws IoError */
PCL_COSECTION_EXPORT void saveViewpoint (const Viewpoint& viewpoint, const std::string& path);

/** \brief Read one. \throws IoError naming the file and what is wrong */
PCL_COSECTION_EXPORT Viewpoint loadViewpoint (const std::string& path);

} // namespace pcl::cosection
