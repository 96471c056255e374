// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_checks.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/LU>

namespace pcl::cosection {

MassProperties
computeMassProperties (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  MassProperties result;
  if (mesh.empty ())
    return result;
  // The signed tetrahedra between each triangle and one point near the mesh add up to its inside.
  const Eigen::Vector3d apex = mesh.vertices[mesh.triangles[0][0]].cast<double> ();
  Eigen::Vector3d first = Eigen::Vector3d::Zero ();  // integral of x
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero (); // integral of x x^T
  for (const auto& triangle : mesh.triangles)
  {
    Eigen::Matrix3d corners;
    for (int n = 0; n < 3; ++n)
      corners.col (n) = mesh.vertices[triangle[n]].cast<double> () - apex;
    const double determinant = corners.determinant ();
    const Eigen::Vector3d sum = corners.rowwise ().sum ();
    result.volume_m3 += determinant / 6.0;
    first += determinant / 24.0 * sum;
    second += determinant / 120.0 * (corners * corners.transpose () + sum * sum.transpose ());
  }
  if (result.volume_m3 == 0.0)
    return result;
  const Eigen::Vector3d centroid = first / result.volume_m3;
  const Eigen::Matrix3d covariance = second - result.volume_m3 * centroid * centroid.transpose ();
  result.centroid_m = apex + centroid;
  result.inertia = covariance.trace () * Eigen::Matrix3d::Identity () - covariance;
  return result;
}

} // namespace pcl::cosection
