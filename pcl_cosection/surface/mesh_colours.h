// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/oriented_point.h>
#include <pcl/cosection/volume/voxel_grid.h>

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief Colour a mesh from coloured points: vertices near points take the mean of those in the voxels
 * around them, the others that of the nearest coloured vertex along the mesh. Nothing is done if all
 * points are black. */
void
transferColours (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, TriangleMesh& mesh);

} // namespace cosection
} // namespace pcl
