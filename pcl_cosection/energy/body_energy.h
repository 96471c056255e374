// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/energy/data/shape_evidence.h"
#include "pcl_cosection/energy/solver/local_solver.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <algorithm>
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
  EnergyProblem problem;                      // equation (1): W and C of (2), the bounds of (3) and (5)
  std::vector<std::uint8_t> free_space;       // 1 where seen free: the complement of the hull
  std::vector<std::uint8_t> empty;            // 1 where seen free, and where a prior expects free space
  std::vector<std::uint8_t> data;             // 1 where points are near
  std::vector<std::uint8_t> expected;         // 1 where a prior expects matter far from points; or empty
  std::vector<std::uint8_t> expects_distance; // 1 where a prior has a target; or empty
  std::vector<std::uint8_t> continued;        // 1 on continued planes; empty if there are no such planes
  std::vector<float> data_distance_vox;       // to the nearest voxel with data
  std::vector<float> carved;                  // signed distance to free space, voxels, finer than the votes; or empty
  NormalBinOccupancy facing;                  // for thin walls, whose two sides are near each other; or empty

  bool hasData () const { return std::find (data.begin (), data.end (), 1) != data.end (); }
};

/** \brief E_data of equation (2), with data terms on continued planes, and E_hull of equation (3). */
BodyEnergy makeBodyEnergy (const ShapeEvidence& evidence, const std::vector<PlaneContinuation>& planes = {});

/** \brief The energy with the data term of \a points, too, where it has no data. The distance to data is still that to
 * the measured ones. */
BodyEnergy withExpectedPoints (const BodyEnergy& energy, const std::vector<OrientedPoint>& points);

/** \brief Upper bound of the bytes that a body on such a grid needs at its peak. */
std::size_t estimateBytes (const VoxelGrid& grid);

/** \brief The signed distance of the measurements alone, sum w f / sum w, supported where there is data. Metres. */
SignedDistanceField measuredField (const BodyEnergy& energy);

/** \brief How finely a body is solved. */
enum class Resolution
{
  Half, ///< voxels of twice the size: an intermediate step, eight times cheaper
  Full,
};

/** \brief The field that minimises a body's energy, and from which the next solve starts. Voxels of the body's grid. */
struct BodySolution
{
  std::vector<float> u;
  std::vector<float> half_u; // at half the resolution
  QuarterResolution quarter; // for followSolution ()
  bool solved_fully = false; // at full resolution

  /** \brief Whether this is a solution at this resolution, or a finer one. */
  bool has (Resolution resolution) const { return !u.empty () && (resolution == Resolution::Half || solved_fully); }
};

/** \brief A solution as a start on another grid of the same lattice; empty if it was not solved at full resolution. */
BodySolution startFrom (const BodySolution& solution, const VoxelGrid& from, const VoxelGrid& to);

/** \brief Minimise, from the last solution if there is one.
 * \throws Cancelled */
SolverSummary solve (const BodyEnergy& energy, Resolution resolution, BodySolution& solution,
                     const ProgressCallback& progress);

/** \brief Minimise after more evidence, for a body whose field is used only near data: everywhere on voxels of four
 * times the size, and at full resolution near data that has changed. Calls solve () the first time, and if most has
 * changed.
 * \param[out] solved_share part of the voxels that was solved at full resolution
 * \throws Cancelled */
SolverSummary followSolution (const BodyEnergy& energy, BodySolution& solution, const ProgressCallback& progress,
                              double& solved_share);

/** \brief The carved minimiser max (u, c) at a voxel, in voxels. */
float carvedValue (const BodyEnergy& energy, const BodySolution& solution, std::size_t voxel);

/** \brief The carved minimiser, supported near data where not seen free, and where matter is expected. Metres. */
SignedDistanceField solvedField (const BodyEnergy& energy, const BodySolution& solution);

} // namespace pcl::cosection
