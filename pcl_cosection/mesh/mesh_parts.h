// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <optional>

namespace pcl::cosection {

/** \brief Triangles that bound something together, and share edges with no others that they need for it. */
struct MeshPart
{
  std::vector<std::uint32_t> triangles; ///< ascending
  bool closed = false;                  ///< as many sides one way as the other at every edge
  double volume_m3 = 0.0;               ///< of a closed part; negative if its triangles face inward
  Eigen::AlignedBox3f box;
};

/** \brief Divide a mesh, in the order of the parts' first triangles. Triangles belong together across an edge
 * of two; across edges of more only where they would be open without each other, and then those that have
 * matter between them. So bodies that merely touch, along an edge or with faces, are parts of their own. */
std::vector<MeshPart> divideMesh (const TriangleMesh& mesh);

/** \brief Some triangles of a mesh, in the given order, with the vertices they use. */
TriangleMesh selectTriangles (const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles);

/** \brief The smallest closed part of positive volume around part \a inner; none if it lies in no other. */
std::optional<std::size_t> enclosingPart (const TriangleMesh& mesh, const std::vector<MeshPart>& parts,
                                          std::size_t inner);

/** \brief The generalised winding number of some triangles about \a p, as a sum of solid angles: 1 inside
 * and 0 outside of a closed outward surface (A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside
 * Segmentation using Generalized Winding Numbers", SIGGRAPH 2013). */
PCL_COSECTION_EXPORT double windingNumber (const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
                                           const Eigen::Vector3d& p);

/** \brief Turn triangles so that neighbours across edges of two agree, the fewest that do, and so that closed
 * parts face outward: all of them if their volumes sum up to less than nothing, then each whose volume is
 * negative unless it is a cavity in another. Where a surface has one side only (a Moebius strip), two
 * neighbours keep disagreeing. */
void orientTriangles (TriangleMesh& mesh);

} // namespace pcl::cosection
