// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_attributes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour unknown_colour = {128, 128, 128};

/** \brief Red, green, blue and intensity of some points. */
struct AttributeSum
{
  Eigen::Vector4d sum = Eigen::Vector4d::Zero ();
  double count = 0.0;
};

/** \brief Sums by voxel. */
using VoxelSums = std::unordered_map<std::size_t, AttributeSum>;

VoxelSums
sumsByVoxel (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, bool measured)
{
  VoxelSums voxels;
  for (const OrientedPoint& point : points)
  {
    const auto at = grid.nearest (point.position.cast<double> ());
    if (!at || (measured && !std::isfinite (point.intensity)))
      continue;
    AttributeSum& voxel = voxels[grid.index (at->x (), at->y (), at->z ())];
    voxel.sum += Eigen::Vector4d (point.colour[0], point.colour[1], point.colour[2], measured ? point.intensity : 0.0f);
    voxel.count += 1.0;
  }
  return voxels;
}

/** \brief The sum over a voxel and its 26 neighbours. */
AttributeSum
sumAround (const VoxelSums& voxels, const VoxelGrid& grid, const Eigen::Vector3i& at)
{
  AttributeSum total;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
      {
        if (!grid.contains (at.x () + dx, at.y () + dy, at.z () + dz))
          continue;
        const auto voxel = voxels.find (grid.index (at.x () + dx, at.y () + dy, at.z () + dz));
        if (voxel == voxels.end ())
          continue;
        total.sum += voxel->second.sum;
        total.count += voxel->second.count;
      }
  return total;
}

/** \brief Vertices along edges of a mesh: those of vertex v are vertices[begin[v]] up to vertices[begin[v + 1]]. */
struct VertexNeighbours
{
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> vertices;
};

VertexNeighbours
vertexNeighbours (const TriangleMesh& mesh)
{
  VertexNeighbours neighbours;
  std::vector<std::uint32_t>& begin = neighbours.begin;
  begin.assign (mesh.vertices.size () + 1, 0);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      begin[v + 1] += 2;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    begin[v + 1] += begin[v];
  neighbours.vertices.resize (begin.back ());
  std::vector<std::uint32_t> next (begin.begin (), begin.end () - 1);
  for (const auto& triangle : mesh.triangles)
    for (int c = 0; c < 3; ++c)
    {
      neighbours.vertices[next[triangle[c]]++] = triangle[(c + 1) % 3];
      neighbours.vertices[next[triangle[c]]++] = triangle[(c + 2) % 3];
    }
  return neighbours;
}

/** \brief Value at the fraction \a t of the way from \a a to \a b. */
float
blended (float a, float b, double t)
{
  return static_cast<float> ((1.0 - t) * a + t * b);
}

TriangleMesh::Colour
blended (const TriangleMesh::Colour& a, const TriangleMesh::Colour& b, double t)
{
  TriangleMesh::Colour result;
  for (std::size_t channel = 0; channel < result.size (); ++channel)
    result[channel] = static_cast<std::uint8_t> (std::lround ((1.0 - t) * a[channel] + t * b[channel]));
  return result;
}

/** \brief Names of kinds, like Provenance, have nothing between them: that of the nearer end. */
std::uint8_t
blended (std::uint8_t a, std::uint8_t b, double t)
{
  return t <= 0.5 ? a : b;
}

} // namespace

void
transferAttributes (const std::vector<OrientedPoint>& points, const VoxelGrid& grid, TriangleMesh& mesh)
{
  const bool coloured = std::any_of (points.begin (), points.end (), [] (const OrientedPoint& p) {
    return p.colour != TriangleMesh::Colour{0, 0, 0};
  });
  const bool measured = std::any_of (points.begin (), points.end (), [] (const OrientedPoint& p) {
    return std::isfinite (p.intensity) && p.intensity != 0.0f;
  });
  if (!coloured && !measured)
    return;
  const VoxelSums voxels = sumsByVoxel (points, grid, measured);
  if (coloured)
    mesh.colours.assign (mesh.vertices.size (), unknown_colour);
  if (measured)
    mesh.intensity.assign (mesh.vertices.size (), 0.0f);
  std::vector<bool> done (mesh.vertices.size (), false);
  std::vector<std::uint32_t> front;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    const auto at = grid.nearest (mesh.vertices[v].cast<double> ());
    const AttributeSum total = at ? sumAround (voxels, grid, *at) : AttributeSum ();
    if (total.count == 0.0)
      continue;
    for (int c = 0; coloured && c < 3; ++c)
      mesh.colours[v][c] = static_cast<std::uint8_t> (std::lround (total.sum[c] / total.count));
    if (measured)
      mesh.intensity[v] = static_cast<float> (total.sum[3] / total.count);
    done[v] = true;
    front.push_back (static_cast<std::uint32_t> (v));
  }

  // Breadth first along the edges from all vertices near points at once.
  const VertexNeighbours neighbours = vertexNeighbours (mesh);
  for (std::size_t head = 0; head < front.size (); ++head)
  {
    const std::uint32_t v = front[head];
    for (std::uint32_t e = neighbours.begin[v]; e < neighbours.begin[v + 1]; ++e)
      if (const std::uint32_t other = neighbours.vertices[e]; !done[other])
      {
        done[other] = true;
        if (coloured)
          mesh.colours[other] = mesh.colours[v];
        if (measured)
          mesh.intensity[other] = mesh.intensity[v];
        front.push_back (other);
      }
  }
}

void
blendAttributes (TriangleMesh& mesh, std::uint32_t u, std::uint32_t v, double t)
{
  const auto blend = [=] (auto& values) {
    if (!values.empty ())
      values[u] = blended (values[u], values[v], t);
  };
  blend (mesh.colours);
  blend (mesh.intensity);
  blend (mesh.confidence);
  blend (mesh.sigma_m);
  blend (mesh.provenance);
}

std::vector<Eigen::Vector3f>
vertexNormals (const TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> sums (mesh.vertices.size (), Eigen::Vector3d::Zero ());
  for (const auto& triangle : mesh.triangles)
    for (int n = 0; n < 3; ++n)
    {
      const Eigen::Vector3d corner = mesh.vertices[triangle[n]].cast<double> ();
      const Eigen::Vector3d a = mesh.vertices[triangle[(n + 1) % 3]].cast<double> () - corner;
      const Eigen::Vector3d b = mesh.vertices[triangle[(n + 2) % 3]].cast<double> () - corner;
      const Eigen::Vector3d area = a.cross (b);
      if (area.norm () > 0.0)
        sums[triangle[n]] += std::atan2 (area.norm (), a.dot (b)) * area.normalized ();
    }
  std::vector<Eigen::Vector3f> normals;
  normals.reserve (sums.size ());
  for (const auto& sum : sums)
    normals.push_back ((sum.norm () > 0.0 ? sum.normalized () : Eigen::Vector3d (0, 0, 1)).cast<float> ());
  return normals;
}

} // namespace pcl::cosection
