// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh_evidence.h"
#include <pcl/cosection/common/triangle_mesh.h>

#include <optional>

namespace pcl::cosection {

/** \brief Find the pose and the scale of a mesh at which it explains an object's points and does not contradict what
 * was seen: from many rotations, by iterative closest points in both directions (P. J. Besl, N. D. McKay, PAMI 1992;
 * with a scale: T. Zinsser, J. Schmidt, H. Niemann, 2005). Of the mesh's surface only what the views should see is
 * matched.
 * \param[in] mesh of any size, not empty
 * \return nothing if there are too few points, or the mesh has no extent */
std::optional<ProposalFit> alignMesh (const TriangleMesh& mesh, const MeasuredObject& object, int threads);

} // namespace pcl::cosection
