// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief The convex hull of points: a closed mesh, and the planes of its faces. */
struct ConvexHull
{
  std::vector<Eigen::Vector3d> corners;          ///< metres
  std::vector<TriangleMesh::Triangle> triangles; ///< of corners, counter-clockwise from outside
  std::vector<Eigen::Vector4d> planes;           ///< one per triangle: unit outward normal n, n.x + d <= 0 inside
  double volume_m3 = 0.0;

  bool empty () const { return triangles.empty (); }

  /** \brief Single precision, as meshes have it. */
  TriangleMesh mesh () const;

  /** \brief How deep a point lies in the hull; negative outside. */
  double depthOf (const Eigen::Vector3d& point) const;
};

/** \brief Compute it by Qhull (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls",
 * ACM TOMS 1996). O (n log n). \return empty if all points lie in a plane, but for rounding */
ConvexHull convexHullOf (const std::vector<Eigen::Vector3d>& points);

/** \brief Whether a part has a volume in single precision, too: simulators make the hull once more. */
bool isSolid (const TriangleMesh& part);

} // namespace pcl::cosection
