// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>

namespace pcl::cosection::test {

using Distance = std::function<double (const Eigen::Vector3d&)>;

inline Distance
sphere (double radius)
{
  return [radius] (const Eigen::Vector3d& p) { return p.norm () - radius; };
}

inline Distance
torus (double ring, double tube)
{
  return [=] (const Eigen::Vector3d& p) { return std::hypot (p.head<2> ().norm () - ring, p.z ()) - tube; };
}

inline Distance
box (const Eigen::Vector3d& half)
{
  return [half] (const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = p.cwiseAbs () - half;
    return q.cwiseMax (0.0).norm () + std::min (q.maxCoeff (), 0.0);
  };
}

/** \brief Call f (index of a voxel, its centre) for all voxels. */
template <typename Function>
void
forEachVoxel (const VoxelGrid& grid, Function&& f)
{
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        f (grid.index (i, j, k), grid.center (i, j, k));
}

/** \brief Samples of \a distance on a cube of the given half edge about the origin. */
inline SignedDistanceField
sampleField (const Distance& distance, double half_edge_m, double voxel_size_m)
{
  SignedDistanceField field;
  const int n = 2 * static_cast<int> (std::ceil (half_edge_m / voxel_size_m)) + 1;
  field.grid.dims.setConstant (n);
  field.grid.voxel_size_m = voxel_size_m;
  field.grid.origin_m.setConstant (-0.5 * voxel_size_m * (n - 1));
  field.values.reserve (field.grid.size ());
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        field.values.push_back (static_cast<float> (distance (field.grid.center (i, j, k))));
  return field;
}

} // namespace pcl::cosection::test
