// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Free space and data of an object's voxels. */
struct SeenVoxels
{
  const std::vector<std::uint8_t>& free;   // 1 where seen free
  const std::vector<float>& data_distance; // to the nearest with data, voxels
};

/** \brief Add a weak data term for the expected hidden side: signed distances from copies of the points, at voxels
 * without data that were not seen free. Shapes with a profile get more weight, as their copies are reliable.
 *
 * The data of the two sides of a vessel's wall overlap and blur each other. So both sides have separate signed
 * distances, measured or else expected; the wall is their intersection, and nowhere much thinner than its mean
 * thickness, as noise would make holes. The cavity is expected to be empty.
 * \param[in,out] problem already with its data term; measured targets at the walls of vessels are replaced
 * \param[in] points all measured points */
void addHiddenSide (EnergyProblem& problem, const VoxelGrid& grid, const SymmetricExtent& plausible,
                    const std::vector<OrientedPoint>& points, const SeenVoxels& seen, const CoSectionOptions& options);

} // namespace pcl::cosection
