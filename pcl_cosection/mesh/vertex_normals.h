// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <vector>

namespace pcl::cosection {

/** \brief Unit normals of the vertices: the triangles' normals weighted by their angles at the vertex, so that it does
 * not matter how flat parts are triangulated. (0, 0, 1) where the triangles' normals cancel or there are none. */
std::vector<Eigen::Vector3f> vertexNormals (const TriangleMesh& mesh);

} // namespace pcl::cosection
