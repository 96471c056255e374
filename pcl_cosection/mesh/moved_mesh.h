// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

namespace pcl::cosection {

/** \brief A mesh that is moved, turned, scaled by one number or mirrored, with its normals. */
template <typename Transform>
TriangleMesh
movedMesh (TriangleMesh mesh, const Transform& T)
{
  const Eigen::Matrix3d linear = Eigen::Affine3d (T).linear ();
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (T * vertex.cast<double> ()).template cast<float> ();
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = (linear * normal.cast<double> ()).normalized ().cast<float> ();
  return mesh;
}

} // namespace pcl::cosection
