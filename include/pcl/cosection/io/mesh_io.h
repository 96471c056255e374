// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <string>

namespace pcl
{
namespace cosection
{

/** \brief Write a mesh; the format follows the extension, through a temporary name.
 *
 * `.ply`: binary little endian; normals, colours, `intensity`, `confidence` (float) and `provenance` (uchar) as
 * vertex properties where the mesh has them. `.stl`: binary. `.obj`: with normals.
 * \throws IoError, InvalidArgument for an unknown extension */
PCL_COSECTION_EXPORT void
saveMesh (const TriangleMesh& mesh, const std::string& path);

/** \brief Read the PLY files that saveMesh () writes (binary little endian, triangles), with their
 * vertex properties. \throws IoError */
PCL_COSECTION_EXPORT TriangleMesh
loadPlyMesh (const std::string& path);

} // namespace cosection
} // namespace pcl
