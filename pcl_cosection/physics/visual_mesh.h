// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/mesh/moved_mesh.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pcl::cosection {

/** \brief The mean of a mesh's colours. */
inline TriangleMesh::Colour
meanColour (const TriangleMesh& mesh, const TriangleMesh::Colour& otherwise)
{
  if (mesh.colours.empty ())
    return otherwise;
  std::array<double, 3> sum{};
  for (const TriangleMesh::Colour& colour : mesh.colours)
    for (int c = 0; c < 3; ++c)
      sum[c] += colour[c];
  TriangleMesh::Colour mean{};
  for (int c = 0; c < 3; ++c)
    mean[c] = static_cast<std::uint8_t> (std::lround (sum[c] / static_cast<double> (mesh.colours.size ())));
  return mean;
}

/** \brief A mesh, with its normals, in another frame. */
inline TriangleMesh
moved (TriangleMesh mesh, const Eigen::Isometry3d& T)
{
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = (T.linear () * normal.cast<double> ()).cast<float> ();
  return movedMesh (std::move (mesh), T);
}

} // namespace pcl::cosection
