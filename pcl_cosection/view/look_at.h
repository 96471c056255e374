// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief Pose of a sensor at \a eye that looks at \a target: z forward, x right, y down, so that \a up points up in
 * its picture; where it looks along \a up, any such pose. \throws InvalidArgument if they are the same place, or \a up
 * is no direction */
PCL_COSECTION_EXPORT Eigen::Isometry3d lookAt (const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                                               const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ ());

/** \brief Pose of a sensor at \a eye that looks along \a axis; the roll does not matter. */
Eigen::Isometry3d lookingAlong (const Eigen::Vector3d& eye, const Eigen::Vector3d& axis);

} // namespace pcl::cosection
