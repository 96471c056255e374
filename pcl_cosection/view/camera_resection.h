// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A camera and where it stood. */
struct LocatedCamera
{
  PinholeCamera camera;
  Eigen::Isometry3d T_points_sensor = Eigen::Isometry3d::Identity ();
};

/** \brief Points in the sensor's frame; NaN if not finite, or at the sensor itself, as missing readings of (0, 0, 0)
 * are that were transformed with the others. */
std::vector<Eigen::Vector3f> takeToSensor (const Eigen::Isometry3d& T_sensor_points,
                                           const std::vector<Eigen::Vector3f>& points);

/** \brief Camera and pose from an organised cloud in any frame, as of a robot's base: each point is on the ray of its
 * pixel, which determines both.
 *
 * The 3 x 4 projection matrix is the one of least algebraic error in normalised coordinates, reweighted to pixels
 * (direct linear transformation: Y. Abdel-Aziz, H. Karara, 1971; R. Hartley, A. Zisserman, "Multiple View Geometry in
 * Computer Vision", 2004, sections 7.1 and 6.2.4), and is divided into intrinsics without skew and a pose. For clouds
 * in the sensor frame fitPinholeCamera () is simpler and more exact.
 * \param[in] points width * height points, row by row; not finite, or at the sensor (takeToSensor ()): no reading
 * \return nothing if the cloud is not the image of a pinhole camera (fitPinholeCamera (), in the frame that was found),
 * or if its points are so nearly on one plane that they do not tell
 * \throws InvalidArgument if there are not width * height points
 *
 * O (width * height); does not depend on the number of threads. */
std::optional<LocatedCamera> locateCamera (const std::vector<Eigen::Vector3f>& points, int width, int height);

/** \brief Whether all rays of an organised cloud are along its z axis, as those of a profile scanner or of an
 * orthographic rendering: x is proportional to the column, and y to the row. */
bool haveParallelRays (const std::vector<Eigen::Vector3f>& points, int width);

/** \brief The depth image that an organised cloud is. \param[in] points in the frame of the camera */
DepthView depthImage (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points,
                      const Eigen::Isometry3d& T_world_sensor);

} // namespace pcl::cosection
