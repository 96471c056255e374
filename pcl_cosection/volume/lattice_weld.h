// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

namespace pcl::cosection {

/** \brief Make one mesh of iso surfaces of the parts of a grid: vertices on the same edge of the grid become one, if
 * they lie on planes in which parts meet. The first of them stays.
 * \param[in] grid of the whole
 * \param[in] spacing of the planes, voxels
 * \param[in] offset number of the grid's first voxel along each axis; planes are at multiples of the spacing */
TriangleMesh weldVertices (const TriangleMesh& mesh, const VoxelGrid& grid, int spacing, const Eigen::Vector3i& offset);

} // namespace pcl::cosection
