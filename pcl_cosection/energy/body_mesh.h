// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "body_energy.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <vector>

namespace pcl::cosection {

/** \brief Closed mesh of the minimiser with provenance and confidence, without components that have no data. */
TriangleMesh closedMesh (const BodyEnergy& energy, const BodySolution& solution);

/** \brief Inner bound: closed mesh of the part of the minimiser's body that lies just behind points. */
TriangleMesh innerMesh (const BodyEnergy& energy, const BodySolution& solution,
                        const std::vector<OrientedPoint>& points);

/** \brief Open mesh of the minimiser, trimmed to its supported part near \a points and continued planes.
 * \param[in] within only the part between these voxels; both ends belong to them. Empty: everywhere */
TriangleMesh trimmedMesh (const BodyEnergy& energy, const BodySolution& solution,
                          const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3i& within = {});

} // namespace pcl::cosection
