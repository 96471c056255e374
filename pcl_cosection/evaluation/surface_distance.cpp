// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_distance.h"

#include "pcl_cosection/volume/mesh_distance/triangle_tree.h"

#include "pcl_cosection/common/parallel.h"
#include "surface_samples.h"

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

/** \brief The triangles that have an area, as TriangleTree wants them. */
TriangleMesh
withArea (const TriangleMesh& mesh)
{
  TriangleMesh result;
  result.vertices = mesh.vertices;
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double> ();
    const Eigen::Vector3d u = mesh.vertices[triangle[1]].cast<double> () - a;
    const Eigen::Vector3d v = mesh.vertices[triangle[2]].cast<double> () - a;
    if (u.cross (v).squaredNorm () > 0.0)
      result.triangles.push_back (triangle);
  }
  return result;
}

} // namespace

SurfaceDistance::SurfaceDistance (const TriangleMesh& mesh)
{
  requireSurface (mesh, "SurfaceDistance");
  const TriangleMesh surface = withArea (mesh);
  tree_ = std::make_unique<TriangleTree> (surface);
  for (const auto& triangle : surface.triangles)
  {
    const Eigen::Vector3d a = surface.vertices[triangle[0]].cast<double> ();
    const Eigen::Vector3d u = surface.vertices[triangle[1]].cast<double> () - a;
    const Eigen::Vector3d v = surface.vertices[triangle[2]].cast<double> () - a;
    normals_.push_back (u.cross (v).normalized ().cast<float> ());
  }
}

SurfaceDistance::~SurfaceDistance () = default;
SurfaceDistance::SurfaceDistance (SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator= (SurfaceDistance&&) noexcept = default;

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
