// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "lattice_weld.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr double same_place_vox = 0.01; // rounding of vertices far from the frame's origin

/** \brief A number for the edge of a grid on which a vertex of an iso surface lies. \param[in] v voxels */
std::uint64_t
edgeOf (const Eigen::Vector3d& v, const VoxelGrid& grid)
{
  const Eigen::Vector3d nearest = v.array ().round ();
  int axis = 0;
  (v - nearest).cwiseAbs ().maxCoeff (&axis);
  Eigen::Vector3i first = nearest.cast<int> ();
  first[axis] = static_cast<int> (std::floor (v[axis]));
  return 3 * static_cast<std::uint64_t> (grid.index (first.x (), first.y (), first.z ())) +
         static_cast<std::uint64_t> (axis);
}

} // namespace

TriangleMesh
weldVertices (const TriangleMesh& mesh, const VoxelGrid& grid, int spacing, const Eigen::Vector3i& offset)
{
  TriangleMesh welded = mesh;
  std::vector<std::uint32_t> target (mesh.vertices.size ());
  std::unordered_map<std::uint64_t, std::uint32_t> first; // by edge
  for (std::uint32_t n = 0; n < target.size (); ++n)
  {
    target[n] = n;
    const Eigen::Vector3d v = grid.toVoxel (mesh.vertices[n].cast<double> ());
    const Eigen::Array3d planes = (v + offset.cast<double> ()).array () / spacing;
    if (((planes - planes.round ()).abs () * spacing < same_place_vox).any ())
      target[n] = first.try_emplace (edgeOf (v, grid), n).first->second;
  }
  for (TriangleMesh::Triangle& triangle : welded.triangles)
    for (std::uint32_t& n : triangle)
      n = target[n];
  return extractTriangles (welded, std::vector<bool> (welded.triangles.size (), true));
}

} // namespace pcl::cosection
