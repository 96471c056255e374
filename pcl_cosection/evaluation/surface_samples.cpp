// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_samples.h"

#include "pcl_cosection/mesh/mesh_checks.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
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

double
areaOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double> ();
  const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double> ();
  const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double> ();
  return 0.5 * (b - a).cross (c - a).norm ();
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

} // namespace pcl::cosection
