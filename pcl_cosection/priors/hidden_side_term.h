// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief What was seen of the voxels of an object. */
struct SeenVoxels
{
  const std::vector<std::uint8_t>& free;   // 1 where seen free
  const std::vector<float>& data_distance; // to the nearest with data, voxels
};

/** \brief Prefer surface where copies of the points make it likely, weakly, where nothing was seen; with more weight
 * for what has a profile, whose copies are where its surface is.
 *
 * The two sides of a vessel's wall are no farther apart than data reaches, and blur each other. So they are told apart:
 * the wall is what is inside of both, each as seen or else as expected, and it is nowhere much thinner than on the
 * average, where noise would make holes. The cavity is expected to be empty.
 * \param[in,out] problem already with its data term; measured targets at the walls of vessels are replaced \param[in]
 * points all that were measured */
void addHiddenSide (EnergyProblem& problem, const VoxelGrid& grid, const SymmetricExtent& plausible,
                    const std::vector<OrientedPoint>& points, const SeenVoxels& seen, const CoSectionOptions& options);

} // namespace pcl::cosection
