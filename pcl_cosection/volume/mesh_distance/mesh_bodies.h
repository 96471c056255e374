// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include "pseudonormals.h"
#include "triangle_tree.h"

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

/** \brief Triangles with what answers questions about them. */
struct PCL_COSECTION_EXPORT SearchableSurface
{
  SearchableSurface (const TriangleMesh& whole, const std::vector<std::uint32_t>& triangles);

  TriangleMesh mesh;
  TriangleTree tree;
  Pseudonormals normals;
  Eigen::AlignedBox3d box;
};

} // namespace pcl::cosection
