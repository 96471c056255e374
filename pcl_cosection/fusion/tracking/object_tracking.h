// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "frame_cloud.h"
#include "pcl_cosection/fusion/event_log.h"
#include "pcl_cosection/fusion/mapping/tracked_object.h"
#include "pose_tracking.h"

#include "pcl_cosection/fusion/association/data_association.h"

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection
{

/** \brief A frame whose camera is known. */
struct PosedFrame
{
  double stamp;
  const FrameCloud& cloud;
  const Eigen::Isometry3d& T_world_camera;
};

/** \brief Track each object relative to the camera. What is not found is hidden or lost.
 * \param[in] expected the background first, then the objects where they should be in this frame
 * \param[in,out] objects of those models but the first */
void trackObjects (const PosedFrame& frame, const std::vector<AssociatedModel>& expected,
                   const std::vector<TrackedObject*>& objects, PoseTracking& tracking, EventLog& log);

} // namespace pcl::cosection
