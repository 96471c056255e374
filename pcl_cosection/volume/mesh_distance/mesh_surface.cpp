// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_surface.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/triangle_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {

Eigen::AlignedBox3d
vertexBox (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
  return box;
}

SurfaceDistance::SurfaceDistance (const TriangleMesh& mesh)
{
  requireSurface (mesh, "SurfaceDistance");
  TriangleMesh surface; // the triangles that have an area, as TriangleTree wants them
  surface.vertices = mesh.vertices;
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d area = areaVector (mesh, triangle);
    if (!(area.squaredNorm () > 0.0))
      continue;
    surface.triangles.push_back (triangle);
    normals_.push_back (area.normalized ().cast<float> ());
  }
  tree_ = std::make_unique<TriangleTree> (surface);
}

std::vector<double>
SurfaceDistance::of (const std::vector<Eigen::Vector3d>& points, int threads) const
{
  std::vector<double> distances (points.size ());
  parallelChunks (0, static_cast<int> (points.size ()), threads, [&] (int first, int last) {
    std::uint32_t hint = 0;
    for (int n = first; n < last; ++n)
    {
      const NearestPoint nearest = tree_->nearest (points[n], std::numeric_limits<double>::infinity (), hint);
      distances[n] = std::sqrt (nearest.squared_m2);
      hint = nearest.triangle;
    }
  });
  return distances;
}

SurfaceDistance::Nearest
SurfaceDistance::nearest (const Eigen::Vector3d& p) const
{
  const NearestPoint found = tree_->nearest (p);
  return {p - found.offset_m, normals_[found.triangle].cast<double> ()};
}

double
shareWithin (const std::vector<double>& distances_m, double threshold_m)
{
  const auto within = std::count_if (distances_m.begin (), distances_m.end (),
                                     [threshold_m] (double d) { return d <= threshold_m; });
  return static_cast<double> (within) / static_cast<double> (distances_m.size ());
}

std::vector<double>
vertexDistances (const TriangleMesh& mesh, const SurfaceDistance& surface, int threads)
{
  std::vector<Eigen::Vector3d> points;
  points.reserve (mesh.vertices.size ());
  for (const Eigen::Vector3f& v : mesh.vertices)
    points.push_back (v.cast<double> ());
  return surface.of (points, threads);
}

} // namespace pcl::cosection
