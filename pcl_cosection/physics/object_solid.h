// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/scene_builder.h"

#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection {

/** \brief What is nearer to a plane or another body than so many voxels touches it. */
constexpr double touching_voxels = 2.0;

/** \brief Volume, centroid and inertia of a mesh of an object. \throws InvalidArgument naming the object if the mesh
 * encloses no volume as a body does: it is open, flat, or turned inside out */
MassProperties solidOf (const CompletedObject& object, const TriangleMesh& mesh);

/** \brief The voxel size of the estimate, or else the mean length of the mesh's edges. */
double voxelSizeOf (const CompletedObject& object);

/** \brief The largest one of all objects. */
double largestVoxelSizeOf (const CompletedScene& scene);

} // namespace pcl::cosection
