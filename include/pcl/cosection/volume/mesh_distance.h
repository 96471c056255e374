// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

namespace pcl::cosection {

/** \brief The signed distance of a mesh at every voxel of a grid: metres, positive outside, negative inside,
 * the exact Euclidean distance up to \a band_m and that with the right sign beyond.
 *
 * The sign is that of the angle-weighted pseudonormal of the nearest face, edge or vertex (J. A. Baerentzen,
 * H. Aanaes, "Signed Distance Computation Using the Angle Weighted Pseudonormal", TVCG 2005); where closed
 * surfaces touch themselves and it has none, that of the generalised winding number. The grid may lie anywhere:
 * within the body, across its surface or far away from it.
 *
 * - <em>Closed parts</em> say everywhere what is inside. Parts may overlap: the result is the smallest
 *   distance of all bodies, negative in their union (there it is how deep a voxel lies in the body that it
 *   lies deepest in). A part that faces inward is a cavity of the part around it; if there is none around
 *   it, it is a room, and all outside is inside.
 * - <em>Open parts</em> (a wall of one quadrilateral, a bin without a lid) are the boundary of matter behind
 *   them: their normals point to free space. They say something only within \a band_m and where the nearest
 *   point is not on their rim, nor on an edge where more than two triangles meet or two disagree. \a supported
 *   is 1 there; where it is 0, the value only continues what is nearby. A mesh of both kinds is
 *   supported inside and within \a band_m of closed parts as well.
 *
 * Vertices of equal coordinates are taken as one. Triangles that lie back to back, as where two bodies share a
 * face, and closed parts without any volume bound nothing and are left out. One part that intersects itself
 * has no defined sign near the intersection. The result is the same for any number of threads.
 * O (triangles log triangles + voxels near the surface * log triangles).
 *
 * \code
 * VoxelGrid grid;
 * grid.dims.setConstant (64);
 * grid.voxel_size_m = 0.005;
 * const auto body = std::make_shared<SignedDistanceField> (sampleSignedDistance (mesh, grid, 0.05));
 * imls.addObstacle (body);
 * \endcode
 *
 * \param[in] mesh triangles counter-clockwise from outside, in the grid's frame
 * \param[in] grid where to sample
 * \param[in] band_m metres, positive
 * \param[in] threads 0: all
 * \return \a supported is empty (everywhere) if all of the mesh is closed
 * \throws InvalidArgument if the mesh has no triangles or bounds nothing, is not consistent or not finite, or
 * the grid has no voxels, or a length is not positive */
PCL_COSECTION_EXPORT SignedDistanceField sampleSignedDistance (const TriangleMesh& mesh, const VoxelGrid& grid,
                                                               double band_m, int threads = 0);

} // namespace pcl::cosection
