// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace pcl::cosection {

/** \brief Signed distance of a point over a plane n.x + d = 0, unit n. */
inline double
heightOver (const Eigen::Vector4d& plane, const Eigen::Vector3d& p)
{
  return plane.head<3> ().dot (p) + plane[3];
}

} // namespace pcl::cosection
