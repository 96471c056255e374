// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "area_samples.h"

#include "mesh_checks.h"
#include "triangle_shape.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl::cosection {
namespace {

double
areaOf (const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle)
{
  return 0.5 * areaVector (mesh, triangle).norm ();
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

AreaSampler::AreaSampler (const TriangleMesh& mesh, std::uint64_t seed, const char* name)
    : mesh_ (mesh)
    , generator_ (seed)
{
  requireSurface (mesh, name);
  up_to_.reserve (mesh.triangles.size ());
  double area = 0.0;
  for (const auto& triangle : mesh.triangles)
    up_to_.push_back (area += areaOf (mesh, triangle));
}

double
AreaSampler::uniform ()
{
  return static_cast<double> (generator_ () >> 11) *
         0x1p-53; // std::uniform_real_distribution differs between libraries
}

MeshPlace
AreaSampler::next ()
{
  MeshPlace place;
  // The first triangle that ends behind the drawn area: never one without area.
  const auto found = std::upper_bound (up_to_.begin (), up_to_.end (), uniform () * area ());
  place.triangle = static_cast<std::size_t> (std::min (found, up_to_.end () - 1) - up_to_.begin ());
  const double r = std::sqrt (uniform ());
  const double s = uniform ();
  place.weights = {1.0 - r, r * (1.0 - s), r * s};
  const auto corner = [&] (int n) { return mesh_.vertices[mesh_.triangles[place.triangle][n]].cast<double> (); };
  place.position = place.weights[0] * corner (0) + place.weights[1] * corner (1) + place.weights[2] * corner (2);
  return place;
}

std::vector<Eigen::Vector3d>
sampleSurface (const TriangleMesh& mesh, std::size_t count, std::uint64_t seed)
{
  AreaSampler sampler (mesh, seed, "sampleSurface");
  std::vector<Eigen::Vector3d> points;
  points.reserve (count);
  while (points.size () < count)
    points.push_back (sampler.next ().position);
  return points;
}

} // namespace pcl::cosection
