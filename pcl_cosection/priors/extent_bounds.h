// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "occlusion_map.h"

#include "extent_prior.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Allowed distance of a voxel from the nearest data, as a fraction of the middle observed extent. */
inline double
allowedFactor (const ExtentPrior& prior, Hidden hidden)
{
  return hidden == Hidden::ByObject  ? prior.depth_factor
         : hidden == Hidden::ByOther ? prior.occluded_factor
                                     : prior.side_factor;
}

/** \brief ExtentPrior::bounds () with the occlusion map \a places of the object's points and views.
 * \param[in] extents_m observedExtents () of its points
 * \param[in] exempt 1 for voxels that get no bound; or empty */
std::vector<float> extentBounds (const ExtentPrior& prior, const VoxelGrid& grid,
                                 const std::vector<float>& data_distance_vox, const Eigen::Vector3d& extents_m,
                                 OcclusionMap& places, const std::vector<SymmetricExtent>& plausible,
                                 const std::vector<std::uint8_t>& exempt, int threads);

} // namespace pcl::cosection
