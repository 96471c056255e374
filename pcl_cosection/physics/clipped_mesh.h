// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief A part of a surface, in double precision. */
struct MeshPiece
{
  std::vector<Eigen::Vector3d> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
};

/** \brief The surface of a mesh. */
MeshPiece pieceOf (const TriangleMesh& mesh);

/** \brief What lies behind a plane, n.x + d <= 0; open where it was cut. */
MeshPiece pieceBehind (const MeshPiece& piece, const Eigen::Vector4d& plane);

/** \brief The vertices behind a plane, and where edges cross it. */
std::vector<Eigen::Vector3d> pointsBehind (const MeshPiece& piece, const Eigen::Vector4d& plane);

/** \brief The generalised winding number of a closed mesh (A. Jacobson et al., "Robust Inside-Outside Segmentation
 * using Generalized Winding Numbers", SIGGRAPH 2013): 1 inside, 0 outside. */
class WindingNumber
{
public:
  explicit WindingNumber (const TriangleMesh& mesh) : mesh_ (mesh) {}

  /** \brief O (triangles). */
  double operator() (const Eigen::Vector3d& point) const;

private:
  const TriangleMesh& mesh_;
};

/** \brief Points with the same convex hull as what of a body lies behind all of some planes: corners of its clipped
 * triangles, and corners of the planes inside it. */
std::vector<Eigen::Vector3d> pointsBetween (const TriangleMesh& mesh, const std::vector<Eigen::Vector4d>& planes,
                                            const WindingNumber& winding);

} // namespace pcl::cosection
