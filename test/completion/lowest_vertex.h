// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <algorithm>
#include <limits>

namespace pcl::cosection::test {

/** \brief Least coordinate of any vertex, by default along z. */
inline float
lowest (const TriangleMesh& mesh, int axis = 2)
{
  float least = std::numeric_limits<float>::infinity ();
  for (const Eigen::Vector3f& v : mesh.vertices)
    least = std::min (least, v[axis]);
  return least;
}

} // namespace pcl::cosection::test
