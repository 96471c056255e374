// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/oriented_point.h>
#include <pcl/cosection/volume/voxel_grid.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief The grid for an object: its box without outliers, padded, at the voxel size of the options.
 *
 * If neither voxel size nor resolution is given, 64 voxels along the longest side, but voxels no smaller
 * than the points' spacing supports: at least three points in each occupied voxel on average.
 * \throws DegenerateInput, MemoryLimitExceeded, InvalidArgument */
VoxelGrid
layoutObject (const std::vector<OrientedPoint>& points, const CoSectionOptions& options);

/** \brief A grid of voxels of the given size over a box. \throws MemoryLimitExceeded, InvalidArgument */
VoxelGrid
layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m, const CoSectionOptions& options);

/** \brief Box of the voxels' centres. */
Eigen::AlignedBox3d
boxOf (const VoxelGrid& grid);

/** \brief Unite boxes that overlap until none do. */
std::vector<Eigen::AlignedBox3d>
uniteOverlapping (std::vector<Eigen::AlignedBox3d> boxes);

} // namespace cosection
} // namespace pcl
