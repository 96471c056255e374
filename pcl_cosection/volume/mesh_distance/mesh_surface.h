// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "triangle_tree.h"

#include "pcl_cosection/mesh/area_samples.h"

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace pcl::cosection {

/** \brief The box around all vertices, of triangles or not. */
PCL_COSECTION_EXPORT Eigen::AlignedBox3d vertexBox (const TriangleMesh& mesh);

/** \brief The exact distance of points to the triangles of a mesh, unsigned, metres.
 *
 * The mesh may be anything that has an area: open, of many parts, with triangles that intersect.
 * O (triangles log triangles) to construct, O (log triangles) for a point near the surface.
 * \code
 * const SurfaceDistance distance (mesh);
 * const std::vector<double> metres = distance.of (points);
 * \endcode */
class PCL_COSECTION_EXPORT SurfaceDistance
{
public:
  /** \throws InvalidArgument, DegenerateInput as requireSurface () */
  explicit SurfaceDistance (const TriangleMesh& mesh);

  /** \brief The distance of each point. \param[in] threads 0: all; without influence on the result */
  std::vector<double> of (const std::vector<Eigen::Vector3d>& points, int threads = 0) const;

  /** \brief The point of the mesh that is nearest to \a p, and the unit normal of its triangle. */
  struct Nearest
  {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;
  };
  Nearest nearest (const Eigen::Vector3d& p) const;

private:
  std::unique_ptr<TriangleTree> tree_;
  std::vector<Eigen::Vector3f> normals_;
};

/** \brief The share of \a distances_m that are at most \a threshold_m. */
PCL_COSECTION_EXPORT double shareWithin (const std::vector<double>& distances_m, double threshold_m);

/** \brief The distance of every vertex of \a mesh to \a surface, metres; of vertices without a triangle as well. */
PCL_COSECTION_EXPORT std::vector<double> vertexDistances (const TriangleMesh& mesh, const SurfaceDistance& surface,
                                                          int threads = 0);

} // namespace pcl::cosection
