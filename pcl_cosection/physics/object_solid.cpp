// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/object_solid.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <string>

namespace pcl::cosection {

namespace {

/** \brief Whether matter of positive density can have this centroid and inertia: each principal moment is at most the
 * sum of the other two. */
bool
isOfMatter (const MassProperties& mass, const TriangleMesh& mesh)
{
  constexpr double rounding = 1e-3;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (mass.inertia).eigenvalues ();
  return box.contains (mass.centroid_m) && moments[0] > 0.0 &&
         moments[2] <= (1.0 + rounding) * (moments[0] + moments[1]);
}

} // namespace

MassProperties
solidOf (const CompletedObject& object, const TriangleMesh& mesh)
{
  const std::string name = "object " + std::to_string (object.id) + ": ";
  if (const MeshTopology topology = computeTopology (mesh); !topology.closed_manifold)
    throw InvalidArgument (name + "its mesh is not closed (" + std::to_string (topology.boundary_edges) +
                           " open edges): it has no volume");
  const MassProperties mass = computeMassProperties (mesh);
  if (mass.volume_m3 < 0.0)
    throw InvalidArgument (name + "its mesh is turned inside out");
  if (!(mass.volume_m3 > 0.0))
    throw InvalidArgument (name + "its mesh has no volume");
  if (!isOfMatter (mass, mesh))
    throw InvalidArgument (name + "its mesh has no inertia as matter has it: it is too thin, or partly turned inside "
                                  "out");
  return mass;
}

double
voxelSizeOf (const CompletedObject& object)
{
  if (object.voxel_size_m > 0.0)
    return object.voxel_size_m;
  double sum = 0.0;
  for (const TriangleMesh::Triangle& t : object.mesh.triangles)
    sum += (object.mesh.vertices[t[1]] - object.mesh.vertices[t[0]]).norm ();
  return sum / static_cast<double> (object.mesh.triangles.size ());
}

double
largestVoxelSizeOf (const CompletedScene& scene)
{
  double largest = 0.0;
  for (const CompletedObject& object : scene.objects)
    largest = std::max (largest, voxelSizeOf (object));
  return largest;
}

} // namespace pcl::cosection
