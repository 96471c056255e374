// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "occlusion_map.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Extents of an object's points (1st to 99th percentile) along their principal axes, metres, largest first.
 * Zero for no points. */
Eigen::Vector3d observedExtents (const std::vector<OrientedPoint>& points, int threads = 0);

/** \brief The extent bound, which prevents swelling: a lower bound of the distance between a voxel and the object.
 *
 * Where no ray and no neighbour bounds a shape, the Hessian term alone continues it without end. An observed surface of
 * the object in front of a hidden voxel suggests matter there, up to a depth that depends on the observed size, as most
 * things are about as deep as they are wide. So a voxel may lie up to a fraction of the middle observed extent from the
 * nearest data:
 *
 *     behind an observed surface of the object, along a viewing ray:  \a depth_factor
 *     behind the surface of something else (occluded):                \a occluded_factor
 *     elsewhere (missing readings, out of view):                      \a side_factor
 *
 * The bound is the excess over this distance, for voxels that were not seen free, with a weak weight. */
struct ExtentPrior
{
  double depth_factor = 0.75;   ///< of the middle observed extent
  double occluded_factor = 0.5; ///< of the middle observed extent
  double side_factor = 0.15;    ///< of the middle observed extent

  /** \brief Parameters for an object whose points were cut out of a scene: its surroundings are unknown, and a missing
   * reading beside it suggests no matter. */
  static ExtentPrior cutOut ()
  {
    ExtentPrior prior;
    prior.side_factor = 0.05;
    return prior;
  }

  /** \brief Largest distance from its data that an object with given extents may have, metres.
   * \param[in] extents_m observedExtents () of its points */
  double farthest (const Eigen::Vector3d& extents_m) const
  {
    return std::max ({depth_factor, occluded_factor, side_factor}) * extents_m[1];
  }

  /** \brief Allowed distance of a voxel from the nearest data, in the unit of the extents. */
  float allowed (const Eigen::Vector3d& extents, Hidden by) const
  {
    const double factor = by == Hidden::ByObject ? depth_factor : by == Hidden::ByOther ? occluded_factor : side_factor;
    return static_cast<float> (factor * extents[1]);
  }

  /** \brief Bounds in voxels; 0 for voxels without a bound.
   * \param[in] data_distance_vox distance to the nearest voxel with data
   * \param[in] points of the object, the grid's frame
   * \param[in] views depth views and their sensors' poses in the grid's frame; if empty, every voxel counts as
   * behind an observed surface */
  std::vector<float> bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                             const std::vector<OrientedPoint>& points, const OcclusionMap::Views& views,
                             int threads = 0) const;

  /** \brief These bounds with the occlusion map \a places of the object's points and views.
   * \param[in] extents_m observedExtents () of its points
   * \param[in] exempt 1 for voxels that get no bound; or empty */
  std::vector<float> bounds (const VoxelGrid& grid, const std::vector<float>& data_distance_vox,
                             const Eigen::Vector3d& extents_m, const OcclusionMap& places,
                             const std::vector<std::uint8_t>& exempt, int threads) const;
};

} // namespace pcl::cosection
