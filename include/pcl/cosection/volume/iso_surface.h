// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief How extractIsoSurface () ends a surface. */
struct PCL_COSECTION_EXPORT IsoSurfaceOptions
{
  bool closed = true; ///< treat the outermost voxels as outside, so that the surface closes inside the volume
  int threads = 0;    ///< 0: all
};

/** \brief Zero level set of a signed distance field as a manifold mesh, in the field's frame, with
 * normals from the field's gradient.
 *
 * Marching cubes with a vertex per cut grid edge (welded by construction) and a face rule that is
 * the same for both cells of a face. No polygon is split by a diagonal in a face of its cell, where
 * the neighbour's diagonal might coincide with it; so every edge belongs to exactly two triangles
 * and every vertex to one fan, for any field. Exact zeros and values that are not finite count as
 * outside; vertices keep away from grid points, so that no triangle degenerates.
 *
 * \code
 * const TriangleMesh mesh = extractIsoSurface (*imls.getSignedDistance ());
 * \endcode
 *
 * With \a closed the result is a closed 2-manifold strictly inside the box of voxel centres. The
 * order of vertices and triangles does not depend on the number of threads. */
PCL_COSECTION_EXPORT TriangleMesh extractIsoSurface (const SignedDistanceField& field,
                                                     const IsoSurfaceOptions& options = {});

/** \brief As extractIsoSurface (), but only in cells whose eight voxels are all marked in \a supported, and never
 * closed: an open mesh without loose vertices, of which every edge has one triangle or two.
 * \param[in] field metres
 * \param[in] supported one per voxel, 0: no; that of \a field is not looked at
 * \param[in] threads 0: all
 * \throws InvalidArgument as extractIsoSurface (), and if there is not one mark per voxel */
PCL_COSECTION_EXPORT TriangleMesh extractOpenIsoSurface (const SignedDistanceField& field,
                                                         const std::vector<std::uint8_t>& supported, int threads = 0);

} // namespace pcl::cosection
