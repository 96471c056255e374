// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "creased_normals.h"

#include "pcl_cosection/mesh/triangle_shape.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

TriangleMesh
withCreasedNormals (const TriangleMesh& mesh)
{
  const double sharp = std::cos (0.6); // radians between neighbours that are apart
  std::vector<Eigen::Vector3d> areas;
  std::vector<std::vector<std::uint32_t>> around (mesh.vertices.size ());
  for (std::uint32_t t = 0; t < mesh.triangles.size (); ++t)
  {
    const auto corner = [&] (int n) { return mesh.vertices[mesh.triangles[t][n]].cast<double> (); };
    areas.push_back (areaVector (corner (0), corner (1), corner (2)));
    for (const std::uint32_t v : mesh.triangles[t])
      around[v].push_back (t);
  }
  TriangleMesh result;
  for (std::uint32_t t = 0; t < mesh.triangles.size (); ++t)
  {
    const auto first = static_cast<std::uint32_t> (result.vertices.size ());
    result.triangles.push_back ({first, first + 1, first + 2});
    for (const std::uint32_t v : mesh.triangles[t])
    {
      Eigen::Vector3d sum = areas[t];
      for (const std::uint32_t other : around[v])
        if (other != t && areas[other].dot (areas[t]) > sharp * areas[other].norm () * areas[t].norm ())
          sum += areas[other];
      result.vertices.push_back (mesh.vertices[v]);
      result.normals.push_back (sum.normalized ().cast<float> ());
    }
  }
  return result;
}

} // namespace pcl::cosection
