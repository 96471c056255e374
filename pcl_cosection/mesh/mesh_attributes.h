// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <vector>

namespace pcl::cosection {

/** \brief Give a mesh the colours and intensities of points: vertices near points take the mean of those in the
 * voxels around them, the others that of the nearest such vertex along the mesh. No colours if all points are
 * black, no intensities if all are zero. */
void transferAttributes (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, TriangleMesh& mesh);

/** \brief Give vertex \a u all attributes, its normal apart, at the fraction \a t of the way from \a u to \a v. */
void blendAttributes (TriangleMesh& mesh, std::uint32_t u, std::uint32_t v, double t);

/** \brief Unit normals of the vertices: the triangles' normals weighted by their angles at the vertex, so that it does
 * not matter how flat parts are triangulated. (0, 0, 1) where the triangles' normals cancel or there are none. */
std::vector<Eigen::Vector3f> vertexNormals (const TriangleMesh& mesh);

} // namespace pcl::cosection
