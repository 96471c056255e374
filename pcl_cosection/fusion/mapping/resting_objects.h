// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "object_map.h"

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief The camera's pose by the background and objects at rest. */
struct HeldPose
{
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< that both together observe; 0: objects were not used, or contradict each other
};

/** \brief Find the camera's pose by the background together with objects that are believed to rest: each is another
 * piece of a world that does not move, until it does. Before a bare table top they observe most.
 *
 * Objects are used for directions that the background does not observe. Gauss-Newton steps minimise the distances of
 * their points to their surfaces at rest, together with the little that the background observes, each in proportion to
 * its precision. If objects contradict each other or the background, some of them move: the poses by all together and
 * by each alone are compared, and the one with which most readings agree is taken; going on as before counts as much as
 * the largest object.
 * \param[in] points sensor frame, with their \a weights as readings of the background
 * \param[in] scene expected models, relative to a camera at \a T_world_camera
 * \param[in] T_world_camera if the camera goes on as before
 * \param[in] by_background T_world_camera by the background alone: kept along directions that nothing observes */
HeldPose holdByRestingObjects (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                               const SceneModels& scene, const Eigen::Isometry3d& T_world_camera,
                               const DataAssociation& association, const Eigen::Isometry3d& by_background);

} // namespace pcl::cosection
