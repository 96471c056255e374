// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "triangle_tree.h"

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief On which side of a mesh a point is, by its nearest point (Baerentzen, Aanaes, TVCG 2005). */
class PCL_COSECTION_EXPORT Pseudonormals
{
public:
  explicit Pseudonormals (const TriangleMesh& mesh);

  /** \brief Above 0 on the side that the triangles face. */
  double side (const NearestPoint& nearest) const;

  /** \brief False for edges of other than two triangles that agree on the direction, and for vertices of such
   * edges or of more than one fan: what side () says about them means nothing. */
  bool isRegular (const NearestPoint& nearest) const;

private:
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<Eigen::Vector3d> faces_;
  std::vector<Eigen::Vector3d> edges_; ///< three per triangle: the sum of the unit normals there
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint8_t> regular_edges_; ///< three per triangle
  std::vector<std::uint8_t> regular_vertices_;
};

} // namespace pcl::cosection
