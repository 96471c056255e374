// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion/analytic_scene.h"

#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

namespace pcl::cosection::benchmark_scenes {

/** \brief A box with a ball on top, standing on a table, as one depth camera sees them: one side, the
 * table around them, and the free space in front. */
struct TableScene
{
  VoxelGrid grid;          ///< a cube around the object, padded as CoSection does
  test::RenderedView seen; ///< labels: 0 the table, 1 the object; world frame
  Eigen::Vector4d table = Eigen::Vector4d::UnitZ ();
};

/** \param[in] resolution voxels along each side of the grid; the camera's pixels shrink with the voxels */
TableScene makeTableScene (int resolution);

/** \brief The whole energy of the object: data, hull, extent prior, and the table as intersection bound. */
EnergyProblem makeEnergyProblem (const TableScene& scene, const CoSectionOptions& options = {});

} // namespace pcl::cosection::benchmark_scenes
