// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/surface_samples.h"
#include "tracked_object.h"

#include "pcl_cosection/fusion/association/data_association.h"

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief What a camera sees, and what it expects to. */
struct ExpectedScene
{
  const std::vector<Eigen::Vector3f>& points; ///< sensor frame
  const std::vector<float>& of_background;    ///< one per point: weight as a reading of the background
  const std::vector<AssociatedModel>&
      models; ///< the background first, objects relative to a camera at \a T_world_camera
  const std::vector<TrackedObject*>& objects; ///< of the models after the first
  const Eigen::Isometry3d& T_world_camera;    ///< if the camera goes on as it did
};

/** \brief Where a camera is. */
struct HeldPose
{
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< that the background and objects tell together; 0: objects were not asked, or do not agree
};

/** \brief Find the camera by the background and by objects that are thought to rest, together: each of them is one more
 * piece of a world that does not move, until it does. Before a bare table top they are what tells most.
 *
 * Objects are asked about directions of which the background does not tell. Gauss-Newton steps minimise the distances
 * of what belongs to them to their surfaces where they have been, together with the little that the background says,
 * each in proportion to its precision. Objects that contradict each other, or the background, do not all rest: the
 * poses that all together and each alone call for are compared, and the one that most readings agree with is taken;
 * going on as before counts as much as the largest object.
 * \param[in] background T_world_camera as the background alone tells it: kept along directions of which nothing tells
 */
HeldPose holdByRestingObjects (const ExpectedScene& scene, const DataAssociation& association,
                               const Eigen::Isometry3d& background);

} // namespace pcl::cosection
