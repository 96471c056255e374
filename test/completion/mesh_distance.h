// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <map>
#include <tuple>
#include <vector>

namespace pcl::cosection::test {

/** \brief Exact distance from points to a mesh, up to a reach. */
class MeshDistance
{
public:
  MeshDistance (const TriangleMesh& mesh, double reach_m);

  /** \brief The distance, clamped to the reach. */
  double operator() (const Eigen::Vector3d& p) const;

private:
  using Cell = std::tuple<int, int, int>;

  const TriangleMesh& mesh_;
  double reach_m_;
  std::map<Cell, std::vector<std::size_t>> triangles_; // of each cell of a reach's edge
};

/** \brief Mean distance of the vertices of \a from to \a to. */
double meanDistance (const TriangleMesh& from, const TriangleMesh& to, double reach_m);

double area (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle);

Eigen::Vector3d centroid (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle);

/** \brief Share of the mesh's area whose triangles' centroids fulfil a condition. */
template <typename Condition>
double
areaShare (const TriangleMesh& mesh, Condition&& condition)
{
  double all = 0.0, share = 0.0;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    const double a = area (mesh, t);
    all += a;
    if (condition (centroid (mesh, t)))
      share += a;
  }
  return all > 0.0 ? share / all : 0.0;
}

} // namespace pcl::cosection::test
