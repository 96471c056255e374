// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/convex_hull_mesh.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief How finely a body is divided. */
struct ConvexDecompositionOptions
{
  int max_parts = 16;       ///< positive
  double max_excess = 0.05; ///< enough: the parts' volumes add up to no more than 1 + this times the body's
  int threads = 0;          ///< 0: all
  /** \brief Points that no part should hold deeper than \a tolerance_m, as other bodies are there. */
  std::vector<Eigen::Vector3d> avoid;
  double tolerance_m = 0.001; ///< of \a avoid
};

/** \brief Divides a closed mesh into convex parts that together contain it.
 *
 * The body is cut by planes, the part with the most excess volume first, where the hulls of both sides become smallest
 * (as K. Mamou, F. Ghorbel, "A simple and efficient approach for 3D mesh approximate convex decomposition", ICIP 2009,
 * and X. Wei et al., "Approximate convex decomposition for 3D meshes with collision-aware concavity and tree search",
 * SIGGRAPH 2022, do); more often than asked, then pairs of parts whose common hull costs least become one. Planes are
 * searched on a mesh of fewer triangles. Each part is the hull of all that the full mesh has between its planes, with
 * the corners of these inside the body, so that no point of the body is outside all parts.
 * \return hulls; one, if the body is nearly convex, or cannot be divided
 * \throws InvalidArgument if the mesh is not closed or has no volume, or an option is out of its domain */
std::vector<ConvexHull> decomposeConvex (const TriangleMesh& mesh, const ConvexDecompositionOptions& options);

} // namespace pcl::cosection
