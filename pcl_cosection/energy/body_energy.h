// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/data/normal_bin_occupancy.h"
#include "pcl_cosection/energy/data/shape_evidence.h"
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief A support plane that is continued where it was not seen, within a region. */
struct PlaneContinuation
{
  Eigen::Vector4d plane;      // unit normal towards free space, the grid's frame
  Eigen::AlignedBox3d region; // the grid's frame
};

/** \brief The energy of one body (an object or a piece of the background) on its grid, with the fields of its terms.
 * Vectors have one value per voxel, x fastest, or are empty. */
struct BodyEnergy
{
  VoxelGrid grid;
  CoSectionOptions options;
  EnergyProblem problem;                // equation (1): W and C of (2), the bounds of (3) and (5)
  std::vector<std::uint8_t> free_space; // 1 where seen free: the complement of the hull
  std::vector<std::uint8_t> empty;      // 1 where seen free, and where a prior expects free space
  std::vector<std::uint8_t> data;       // 1 where points are near
  std::vector<std::uint8_t> continued;  // 1 on continued planes; empty if there are no such planes
  std::vector<float> data_distance_vox; // to the nearest voxel with data
  std::vector<float> carved;            // signed distance to free space, voxels, finer than the votes; or empty
  NormalBinOccupancy facing;            // for thin walls, whose two sides are near each other; or empty

  bool hasData () const;
};

/** \brief E_data of equation (2), with data terms on continued planes, and E_hull of equation (3). */
BodyEnergy makeBodyEnergy (const ShapeEvidence& evidence, const std::vector<PlaneContinuation>& planes = {});

/** \brief Upper bound of the bytes that a body on such a grid needs at its peak. */
std::size_t estimateBytes (const VoxelGrid& grid);

/** \brief The signed distance of the measurements alone, sum w f / sum w, supported where there is data. Metres. */
SignedDistanceField measuredField (const BodyEnergy& energy);

} // namespace pcl::cosection
