// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_distance.h"

#include "common/triangle_distance.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace pcl::cosection::test {

MeshDistance::MeshDistance (const TriangleMesh& mesh, double reach_m) : mesh_ (mesh), reach_m_ (reach_m)
{
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
  {
    Eigen::AlignedBox3d box;
    for (const auto v : mesh.triangles[t])
      box.extend (mesh.vertices[v].cast<double> ());
    const Eigen::Vector3i low = (box.min () / reach_m).array ().floor ().cast<int> ();
    const Eigen::Vector3i high = (box.max () / reach_m).array ().floor ().cast<int> ();
    for (int k = low.z (); k <= high.z (); ++k)
      for (int j = low.y (); j <= high.y (); ++j)
        for (int i = low.x (); i <= high.x (); ++i)
          triangles_[Cell (i, j, k)].push_back (t);
  }
}

double
MeshDistance::operator() (const Eigen::Vector3d& p) const
{
  const Eigen::Vector3i cell = (p / reach_m_).array ().floor ().cast<int> ();
  double nearest = reach_m_;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
      {
        const auto found = triangles_.find (Cell (cell.x () + dx, cell.y () + dy, cell.z () + dz));
        if (found == triangles_.end ())
          continue;
        for (const std::size_t t : found->second)
        {
          const auto vertex = [&] (int i) -> Eigen::Vector3d {
            return mesh_.vertices[mesh_.triangles[t][i]].cast<double> ();
          };
          nearest = std::min (nearest, distanceToTriangle (p, vertex (0), vertex (1), vertex (2)));
        }
      }
  return nearest;
}

double
meanDistance (const TriangleMesh& from, const TriangleMesh& to, double reach_m)
{
  const MeshDistance distance (to, reach_m);
  double sum = 0.0;
  for (const Eigen::Vector3f& v : from.vertices)
    sum += distance (v.cast<double> ());
  return sum / static_cast<double> (std::max<std::size_t> (1, from.vertices.size ()));
}

double
area (const TriangleMesh& mesh, const TriangleMesh::Triangle& t)
{
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double> ();
  return 0.5 * (mesh.vertices[t[1]].cast<double> () - a).cross (mesh.vertices[t[2]].cast<double> () - a).norm ();
}

Eigen::Vector3d
centroid (const TriangleMesh& mesh, const TriangleMesh::Triangle& t)
{
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).cast<double> () / 3.0;
}

} // namespace pcl::cosection::test
