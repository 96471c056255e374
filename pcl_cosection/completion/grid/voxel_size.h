// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief The smallest voxel size that the points' spacing supports, of those that give at most 64 voxels along the
 * longest side: at least three points in each occupied voxel on average, or 1.5 if voxels were larger than a 16th of
 * the longest side. */
double supportedVoxelSize (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed);

/** \brief Spacing and noise of points. */
struct PointSpacing
{
  double supported_m = 0.0; // supportedVoxelSize ()
  double noise_m = 0.0;     // standard deviation along the normal, median over the surface; 0 with too few points
};

PointSpacing measureSpacing (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed);

/** \brief Whether the options give a voxel size or a resolution for objects. */
bool fixedVoxelSize (const CoSectionOptions& options);

/** \brief The voxel size of the options. If neither it nor a resolution is given, 64 voxels along the longest side,
 * but voxels no smaller than .65 times those that the points' spacing supports (supportedVoxelSize ()), nor, up to the
 * size of those, than 1.6 times the points' noise.
 * \throws InvalidArgument */
double objectVoxelSize (const PointSpacing& spacing, const Eigen::AlignedBox3d& observed,
                        const CoSectionOptions& options);

/** \brief Voxel size of a vessel (SymmetricExtent::wallThickness ()): half of its wall thickness, if that is smaller
 * than \a supported_m, but no less than half of \a supported_m and a 64th of the longest side. Voxels finer than the
 * points' spacing supports are possible, as points have copies on all sides. */
double vesselVoxelSize (double supported_m, double wall_m, const Eigen::AlignedBox3d& observed);

} // namespace pcl::cosection
