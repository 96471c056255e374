// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection {

/** \brief The surface with the connectivity that its coordinates imply: vertices of equal
 * coordinates are one, triangles of two equal corners are gone, repeated ones are there once, and those of
 * three corners on a line are gone without opening a gap: the triangle at their longest side is divided.
 * Vertices keep their order; those without a triangle, and all vertex properties, are dropped. */
PCL_COSECTION_EXPORT TriangleMesh cleanMesh (const TriangleMesh& mesh);

/** \brief Drop all triangles that lie back to back (the same corners in opposite order): they bound
 * nothing. */
PCL_COSECTION_EXPORT TriangleMesh dropBackToBack (const TriangleMesh& mesh);

} // namespace pcl::cosection
