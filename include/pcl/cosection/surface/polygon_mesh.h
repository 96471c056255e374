// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <pcl/PolygonMesh.h>

namespace pcl::cosection
{

/** \brief As PCL's mesh: fields x y z, normal_x normal_y normal_z, rgb, intensity, confidence (float) and provenance
 * (unsigned char), as far as \a mesh has them. The header is left alone.
 * \throws InvalidArgument if the vertices need more than 4 GiB, PCL's limit */
PCL_COSECTION_EXPORT void toPolygonMesh (const TriangleMesh& mesh, pcl::PolygonMesh& output);

/** \brief Vertices and faces of PCL's mesh; polygons are split into triangles around their first vertex.
 * \throws InvalidArgument if it has no fields x, y and z of floats, or a polygon of fewer than three vertices or of
 * vertices that do not exist */
PCL_COSECTION_EXPORT TriangleMesh fromPolygonMesh (const pcl::PolygonMesh& mesh);

} // namespace pcl::cosection
