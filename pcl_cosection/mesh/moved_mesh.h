// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief A mesh whose vertices are moved, turned, scaled or mirrored; it must have no normals. */
template <typename Transform>
TriangleMesh
movedMesh (TriangleMesh mesh, const Transform& T)
{
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (T * vertex.cast<double> ()).template cast<float> ();
  return mesh;
}

} // namespace pcl::cosection
