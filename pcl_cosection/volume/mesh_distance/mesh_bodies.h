// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "triangle_tree.h"

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief The triangles of each closed body, cavities with what is around them, and those of all open parts. */
struct PCL_COSECTION_EXPORT MeshBodies
{
  std::vector<std::vector<std::uint32_t>> bodies;
  std::vector<std::uint32_t> sheets;
};

/** \brief Divide a mesh into what sampleSignedDistance () takes for solid, and open sheets. Closed parts without any
 * volume are in neither.
 * \param[in] mesh cleaned (cleanMesh (), dropBackToBack ()) */
PCL_COSECTION_EXPORT MeshBodies divideBodies (const TriangleMesh& mesh);

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

/** \brief Triangles with what answers questions about them: those of a body, or open ones. */
struct PCL_COSECTION_EXPORT SearchableSurface
{
  SearchableSurface (const TriangleMesh& whole, const std::vector<std::uint32_t>& triangles);

  /** \brief As that of the normals; 0 where the nearest point does not determine it. */
  double side (const NearestPoint& nearest) const;

  /** \brief Whether a point is in a body, or in the matter around a room. O (triangles). */
  bool isInMatter (const Eigen::Vector3d& p) const;

  TriangleMesh mesh;
  std::vector<std::uint32_t> all; ///< its triangles
  TriangleTree tree;
  Pseudonormals normals;
  Eigen::AlignedBox3d box;
  bool is_room = false; ///< of a body: it faces inward, matter is all around it
};

} // namespace pcl::cosection
