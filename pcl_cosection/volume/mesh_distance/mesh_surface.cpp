// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_surface.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/mesh_checks.h"
#include "pcl_cosection/mesh/triangle_shape.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace pcl::cosection {
namespace {

/** \brief Uniform in [0, 1); std::uniform_real_distribution differs between standard libraries. */
double
uniform (std::mt19937_64& generator)
{
  return static_cast<double> (generator () >> 11) * 0x1p-53;
}

Eigen::Vector3d
areaVectorOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  const auto corner = [&] (int n) { return mesh.vertices[triangle[n]].cast<double> (); };
  return areaVector (corner (0), corner (1), corner (2));
}

double
areaOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  return 0.5 * areaVectorOf (mesh, triangle).norm ();
}

} // namespace

double
surfaceArea (const TriangleMesh& mesh)
{
  double area = 0.0;
  for (const auto& triangle : mesh.triangles)
    area += areaOf (mesh, triangle);
  return area;
}

Eigen::AlignedBox3d
vertexBox (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v.cast<double> ());
  return box;
}

void
requireSurface (const TriangleMesh& mesh, const char* name)
{
  checkMesh (mesh);
  if (mesh.empty ())
    throw DegenerateInput (std::string (name) + ": the mesh has no triangles");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      if (!mesh.vertices[v].allFinite ())
        throw InvalidArgument (std::string (name) + ": vertex " + std::to_string (v) + " of the mesh is not finite");
  if (!(surfaceArea (mesh) > 0.0))
    throw DegenerateInput (std::string (name) + ": all triangles of the mesh are without area");
}

std::vector<Eigen::Vector3d>
sampleSurface (const TriangleMesh& mesh, std::size_t count, std::uint64_t seed)
{
  requireSurface (mesh, "sampleSurface");
  std::vector<double> up_to; // area of the triangles up to and including each
  up_to.reserve (mesh.triangles.size ());
  double area = 0.0;
  for (const auto& triangle : mesh.triangles)
    up_to.push_back (area += areaOf (mesh, triangle));

  std::mt19937_64 generator (seed);
  std::vector<Eigen::Vector3d> points;
  points.reserve (count);
  while (points.size () < count)
  {
    // The first triangle that ends behind the drawn area: never one without area.
    const auto found = std::upper_bound (up_to.begin (), up_to.end (), uniform (generator) * area);
    const auto t = static_cast<std::size_t> (std::min (found, up_to.end () - 1) - up_to.begin ());
    const double r = std::sqrt (uniform (generator));
    const double s = uniform (generator);
    const auto corner = [&] (int n) { return mesh.vertices[mesh.triangles[t][n]].cast<double> (); };
    points.push_back ((1.0 - r) * corner (0) + r * (1.0 - s) * corner (1) + r * s * corner (2));
  }
  return points;
}

SurfaceDistance::SurfaceDistance (const TriangleMesh& mesh)
{
  requireSurface (mesh, "SurfaceDistance");
  TriangleMesh surface; // the triangles that have an area, as TriangleTree wants them
  surface.vertices = mesh.vertices;
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d area = areaVectorOf (mesh, triangle);
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
