// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief Whether a pose, perhaps kept in single precision, is a finite rigid motion. */
inline bool
isRigidMotion (const Eigen::Isometry3d& pose)
{
  constexpr double tolerance = 1e-3;
  return pose.matrix ().allFinite () && pose.linear ().isUnitary (tolerance) && pose.linear ().determinant () > 0.0;
}

} // namespace pcl::cosection
