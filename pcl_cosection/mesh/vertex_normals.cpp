// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "vertex_normals.h"

#include <Eigen/Geometry>

#include <cmath>

namespace pcl::cosection {

std::vector<Eigen::Vector3f>
vertexNormals (const TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> sums (mesh.vertices.size (), Eigen::Vector3d::Zero ());
  for (const auto& triangle : mesh.triangles)
    for (int n = 0; n < 3; ++n)
    {
      const Eigen::Vector3d corner = mesh.vertices[triangle[n]].cast<double> ();
      const Eigen::Vector3d a = mesh.vertices[triangle[(n + 1) % 3]].cast<double> () - corner;
      const Eigen::Vector3d b = mesh.vertices[triangle[(n + 2) % 3]].cast<double> () - corner;
      const Eigen::Vector3d area = a.cross (b);
      if (area.norm () > 0.0)
        sums[triangle[n]] += std::atan2 (area.norm (), a.dot (b)) * area.normalized ();
    }
  std::vector<Eigen::Vector3f> normals;
  normals.reserve (sums.size ());
  for (const auto& sum : sums)
    normals.push_back ((sum.norm () > 0.0 ? sum.normalized () : Eigen::Vector3d (0, 0, 1)).cast<float> ());
  return normals;
}

} // namespace pcl::cosection
