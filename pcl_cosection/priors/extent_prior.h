// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief How large an object appears: extents of its points (1st to 99th percentile) along their
 * principal axes, metres, largest first. Zero for no points. */
Eigen::Vector3d observedExtents (const std::vector<OrientedPoint>& points, int threads = 0);

/** \brief Remedy for swelling: a distance that a voxel should keep from the object because nothing
 * suggests that the object reaches it.
 *
 * Where no ray and no neighbour bounds a shape, the Hessian term alone continues it without end. What
 * speaks for matter in a hidden voxel is an observed surface of the object in front of it, and for how far
 * behind that surface, the size of what was observed: most things are about as deep as they are wide. So a
 * voxel may lie up to a fraction of the middle observed extent from the nearest data:
 *
 *     behind an observed surface of the object, along a viewing ray:  \a depth_factor
 *     behind the surface of something else (occluded):                \a occluded_factor
 *     elsewhere (missing readings, out of view):                      \a side_factor
 *
 * What it exceeds that by is the bound, to be applied with a weak weight to voxels that were not seen
 * free.
 *
 * Where a plausible region is given (SymmetricExtent), a voxel is also to keep the distance by which it lies beyond
 * that region, less max (\a symmetric_margin e2, \a least_depth e2 - e3), e2 and e3 the middle and the smallest
 * observed extent: of a thing of which one flat face was seen, the region is that face. Voxels that something else
 * hides are left out. The larger bound counts. */
struct ExtentPrior
{
  double depth_factor = 0.75;     ///< of the middle observed extent
  double occluded_factor = 0.5;   ///< of the middle observed extent
  double side_factor = 0.15;      ///< of the middle observed extent
  double symmetric_margin = 0.02; ///< around the plausible region, of the middle observed extent
  double least_depth = 0.25;      ///< that an object is taken to have, of the middle observed extent

  /** \brief For an object whose points were cut out of a scene: what they stood on is gone, and a missing reading
   * beside them suggests no matter. */
  static ExtentPrior cutOut ();

  /** \brief Largest distance from its data that an object may have, metres. */
  double farthest (const std::vector<OrientedPoint>& points) const;

  /** \brief The same. \param[in] extents_m observedExtents () of its points */
  double farthest (const Eigen::Vector3d& extents_m) const;

  /** \brief Bounds in voxels, 0 where there is none.
   * \param[in] data_distance_vox distance to the nearest voxel with data
   * \param[in] points the object's, the grid's frame
   * \param[in] views depth views and their sensors' poses in the grid's frame; none: every voxel counts as
   * behind an observed surface
   * \param[in] plausible regions of which any may hold the object, the grid's frame; none: no such bound */
  std::vector<float> bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                             const std::vector<OrientedPoint>& points,
                             const std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>& views, int threads = 0,
                             const std::vector<SymmetricExtent>& plausible = {}) const;
};

} // namespace pcl::cosection
