// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/occlusion_map.h"

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Box of an object's points without outliers. \throws DegenerateInput */
Eigen::AlignedBox3d observedBox (const std::vector<OrientedPoint>& points, int threads = 0);

/** \brief Box of the region where an object may be, with a margin: where ExtentPrior gives no bound, above all
 * \a planes, united with \a known.
 * \param[in] extents_m observedExtents () of the points
 * \param[in] views depth views and their sensors' poses in the points' frame
 * \param[in] places occlusion by those views */
Eigen::AlignedBox3d possibleBox (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed,
                                 const Eigen::AlignedBox3d& known, const Eigen::Vector3d& extents_m,
                                 double voxel_size_m, const OcclusionMap::Views& views, const OcclusionMap& places,
                                 const std::vector<Eigen::Vector4d>& planes, int threads);

/** \brief Box of the space in \a within that no view saw free and that is connected with points, with a margin; for
 * ObjectHull.
 * \param[in] views depth views and their sensors' poses in the points' frame
 * \param[in] planes that bound the space, normals towards the points; it does not extend along the layer of \a layer_m
 * on them */
Eigen::AlignedBox3d unseenBox (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed,
                               const Eigen::AlignedBox3d& within, double voxel_size_m, const OcclusionMap::Views& views,
                               const std::vector<Eigen::Vector4d>& planes, double layer_m);

/** \brief A grid of voxels of the given size over a box. \throws InvalidArgument */
VoxelGrid layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m);

/** \brief \throws MemoryLimitExceeded if a volume needs more than is left
 * \param[in] limit_bytes 0: no limit
 * \param[in] used_bytes memory in use */
void checkMemory (const VoxelGrid& grid, std::size_t limit_bytes, std::size_t used_bytes);

/** \brief Box of the voxels' centres. */
Eigen::AlignedBox3d boxOf (const VoxelGrid& grid);

std::vector<Eigen::Vector3d> corners (const Eigen::AlignedBox3d& box);

/** \brief Unite boxes that overlap until none do. */
std::vector<Eigen::AlignedBox3d> uniteOverlapping (std::vector<Eigen::AlignedBox3d> boxes);

} // namespace pcl::cosection
