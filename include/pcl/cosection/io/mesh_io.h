// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <string>

namespace pcl::cosection {

/** \brief Write a mesh; the format follows the extension, through a temporary name.
 *
 * `.ply`: binary little endian; normals, colours, `intensity`, `confidence`, `sigma_m` (float) and `provenance` (uchar)
 * as vertex properties where the mesh has them. `.stl`: binary. `.obj`: with normals.
 * \param[in] mesh metres \param[in] path of the file
 * \param[in] origin is added to the vertices; if it is not zero, PLY files have coordinates of double precision, and
 * STL files, which know single precision alone, leave it out
 * \throws IoError, InvalidArgument for an unknown extension */
PCL_COSECTION_EXPORT void saveMesh (const TriangleMesh& mesh, const std::string& path,
                                    const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief Read a PLY file of triangles with the vertex properties that saveMesh () writes, as it is.
 * \param[in] path of the file \param[in] origin is subtracted from the vertices before they are rounded to single
 * precision
 * \throws IoError */
PCL_COSECTION_EXPORT TriangleMesh loadPlyMesh (const std::string& path,
                                               const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief Read the surface of any mesh file: PLY, STL, OBJ, OFF, VTK's legacy format (`.vtk` of POLYDATA) and its
 * XML format (`.vtp`), text or binary. What the file begins with decides on the format where it can, else the
 * extension.
 *
 * The result is ready for sampleSignedDistance (): polygons and strips are triangulated, vertices of equal
 * coordinates (an STL file has no others) are one, triangles that repeat others or have no area are gone, the
 * triangles of one surface agree on their side (the fewest are turned), and what is closed faces outward, save
 * cavities. Open surfaces face as most of their triangles do in the file. Only positions are kept, in the
 * file's units; vertices without a triangle are dropped.
 * \param[in] path of the file \param[in] origin is subtracted from the vertices before they are rounded to single
 * precision
 * \throws IoError if the file cannot be read, has no known format, is damaged or cut off, has no triangles of
 * any area, or vertices of these that are not finite */
PCL_COSECTION_EXPORT TriangleMesh loadMesh (const std::string& path,
                                            const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief An origin near a mesh whose coordinates are too far from zero for single precision, of round numbers; zero
 * for others. \throws IoError as loadMesh () */
PCL_COSECTION_EXPORT Eigen::Vector3d localOrigin (const std::string& path);

/** \brief Write a signed distance field as VTK image data (`.vti`): point arrays
 * `signed_distance` (float, metres) and, if present, `supported` (unsigned char); the origin is the
 * first voxel's centre. Through a temporary name.
 * \param[in] field metres \param[in] path of the file \param[in] origin is added to that of the field
 * \throws IoError */
PCL_COSECTION_EXPORT void saveSignedDistance (const SignedDistanceField& field, const std::string& path,
                                              const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

} // namespace pcl::cosection
