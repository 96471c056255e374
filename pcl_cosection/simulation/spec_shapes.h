// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spec_node.h"

#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>

namespace pcl::cosection {

/** \brief A rotation from the fields rpy_deg or quaternion; the identity without either. */
Eigen::Quaterniond parseRotation (SpecNode& node);

/** \brief A part of a body: shape, place and colour. */
BodyPart parsePart (SpecNode node, const TriangleMesh::Colour& colour, const std::string& folder);

TriangleMesh::Colour parseColour (SpecNode& node, const TriangleMesh::Colour& otherwise);

} // namespace pcl::cosection
