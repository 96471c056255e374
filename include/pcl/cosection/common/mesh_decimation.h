// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <cstddef>

namespace pcl::cosection {

/** \brief How far decimate () goes, and what it must not do. */
struct PCL_COSECTION_EXPORT DecimationOptions
{
  std::size_t max_triangles = 0;     ///< stop at this many; must be set
  double max_normal_turn_deg = 80.0; ///< no triangle turns further in one collapse
  /** \brief Collapses that make triangles thinner than this wait until all others do noticeably more harm;
   * 4 sqrt (3) area / sum of squared sides: 1 for equilateral triangles, 0 for degenerate ones. */
  double min_quality = 0.1;
  double boundary_weight = 10.0; ///< weight of the distance to an open boundary, relative to that to the surface

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Represents a surface with fewer triangles: edges collapse, the least harmful first, until no more than
 * \a max_triangles are left.
 *
 * The harm is the quadric error of M. Garland, P. Heckbert, "Surface Simplification Using Quadric Error Metrics",
 * SIGGRAPH 1997, weighted by area: the squared distance to the planes of all original triangles that a vertex stands
 * for. The new vertex is where that is smallest; along directions in which it hardly changes (in a plane, along a
 * crease) it stays at the middle of the edge. Boundaries of open meshes are held by planes perpendicular to the
 * surface.
 *
 * An edge collapses only under the link condition (T. Dey, H. Edelsbrunner, S. Guha, D. Nekhayev, "Topology Preserving
 * Edge Contraction", 1999): a closed manifold stays a closed manifold, and each component keeps its Euler
 * characteristic and its boundaries. No component disappears, and no triangle flips, so the surface hardly ever cuts
 * through itself unless the target is near the least that its handles allow. If the target cannot be reached
 * under these conditions (a closed component has no less than 4 triangles, one with handles needs more), the result is
 * the smallest that was reached. Of a closed mesh whose volume would shrink to less than a tenth, as with thin walls
 * that fall onto each other, or be turned inside out, more triangles are left.
 *
 * Normals are computed anew, from the triangles and their angles at each vertex. Colours, intensity, confidence and
 * sigma_m are interpolated along the collapsed edges, provenance is that of the nearer end. Empty arrays stay empty.
 * Vertices that no triangle uses are left out.
 *
 * A mesh that has no more than \a max_triangles is returned as it is.
 * The result is the same whenever the input is. O (n log n) time; runs on the calling thread.
 * \code
 * const TriangleMesh small = decimate (mesh, 10000);
 * \endcode
 * \throws InvalidArgument if an option is outside its domain, or the mesh is to shrink but is not a manifold (with or
 * without boundary, consistently oriented) or has a vertex that is not finite */
PCL_COSECTION_EXPORT TriangleMesh decimate (const TriangleMesh& mesh, const DecimationOptions& options);

/** \brief Decimation to \a max_triangles, with the defaults of the other options. */
PCL_COSECTION_EXPORT TriangleMesh decimate (const TriangleMesh& mesh, std::size_t max_triangles);

} // namespace pcl::cosection
