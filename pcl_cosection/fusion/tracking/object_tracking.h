// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/mapping/object_map.h"
#include "pcl_cosection/fusion/run_log.h"
#include "pose_estimate.h"

namespace pcl::cosection {

/** \brief Track each active object relative to the camera. An object that is not found is hidden or lost.
 * \param[in] background volume of the same world */
void trackObjects (const PosedFrame& frame, const TsdfVolume& background, const PoseSolver& solver, ObjectMap& objects,
                   EventLog& log);

/** \brief Find an object again from points that are all supposed to be its own. \param[in] guess T_model_camera */
PoseEstimate findObject (const FrameCloud& cloud, const std::vector<Eigen::Vector3f>& points, const TsdfVolume& volume,
                         const Eigen::Isometry3d& guess, SdfAlignment& alignment);

} // namespace pcl::cosection
