// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "intersection_constraint.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/volume/mesh_distance/brick_distances.h"

#include <algorithm>
#include <optional>

namespace pcl::cosection {

Eigen::AlignedBox3i
coveredVoxels (const VoxelGrid& grid, const Eigen::Isometry3d& T_body_grid, const VoxelGrid& body)
{
  const Eigen::Isometry3d T_grid_body = T_body_grid.inverse ();
  Eigen::AlignedBox3d covered; // voxels
  for (const Eigen::Vector3d& corner : corners (body))
    covered.extend (grid.toVoxel (T_grid_body * corner));
  const Eigen::Array3d dims = grid.dims.cast<double> ();
  return {covered.min ().array ().max (0.0).min (dims).floor ().cast<int> ().matrix (),
          ((covered.max ().array () + 1.0).max (0.0).min (dims).ceil ().cast<int> () - 1).matrix ()};
}

IntersectionConstraint::IntersectionConstraint (const VoxelGrid& grid, double max_bound_vox, int threads)
    : grid_ (grid)
    , max_bound_vox_ (static_cast<float> (max_bound_vox))
    , threads_ (threads)
{}

void
IntersectionConstraint::raise (std::size_t n, float distance_vox, float beta)
{
  const float d = std::min (distance_vox, max_bound_vox_);
  if (d > distance_vox_[n] || (d == distance_vox_[n] && beta > beta_[n]))
  {
    distance_vox_[n] = d;
    beta_[n] = beta;
  }
}

void
IntersectionConstraint::addBody (const SignedDistanceField& body, const std::vector<Eigen::Isometry3d>& T_body_grid,
                                 double beta)
{
  std::optional<InsideBricks> inside; // of bodies that are near: a scene has many that are not
  for (const Eigen::Isometry3d& T : T_body_grid)
  {
    if (coveredVoxels (grid_, T, body.grid).isEmpty ())
      continue;
    if (!inside)
      inside.emplace (body, threads_);
    if (inside->any ())
      addBody (body, *inside, T, static_cast<float> (beta));
  }
}

void
IntersectionConstraint::addBody (const SignedDistanceField& body, const InsideBricks& inside,
                                 const Eigen::Isometry3d& T_body_grid, float beta)
{
  const Eigen::AlignedBox3i covered = coveredVoxels (grid_, T_body_grid, body.grid);
  const Eigen::Vector3i first = covered.min (), last = covered.max ().array () + 1;
  distance_vox_.resize (grid_.size (), 0.0f);
  beta_.resize (grid_.size (), 0.0f);
  const auto to_voxels = static_cast<float> (1.0 / grid_.voxel_size_m);
  const Eigen::Vector3d step = T_body_grid.linear ().col (0) * (grid_.voxel_size_m / body.grid.voxel_size_m);
  const double steps_per_voxel = 1.0 / step.cwiseAbs ().maxCoeff ();
  parallelFor (first.z (), last.z (), threads_, [&] (int k) {
    for (int j = first.y (); j < last.y (); ++j)
    {
      const Eigen::Vector3d start = body.grid.toVoxel (T_body_grid * grid_.center (0, j, k));
      for (int i = first.x (); i < last.x (); ++i)
      {
        const Eigen::Vector3d v = start + i * step;
        const int empty = inside.emptyVoxels (v);
        if (empty > 0)
          i += static_cast<int> (empty * steps_per_voxel - 0.01); // skip empty voxels, with a margin for rounding
        if (empty >= 0)
          continue;
        if (const auto u = body.sampleInside (v))
          raise (grid_.index (i, j, k), -*u * to_voxels, beta);
      }
    }
  });
}

void
IntersectionConstraint::addHalfSpace (const Eigen::Vector4d& plane, const std::vector<std::uint8_t>& free_space,
                                      double beta)
{
  distance_vox_.resize (grid_.size (), 0.0f);
  beta_.resize (grid_.size (), 0.0f);
  parallelFor (0, grid_.dims.z (), threads_, [&] (int k) {
    for (int j = 0; j < grid_.dims.y (); ++j)
    {
      const double height_of_row = heightOver (plane, grid_.center (0, j, k)) / grid_.voxel_size_m;
      for (int i = 0; i < grid_.dims.x (); ++i)
      {
        const std::size_t n = grid_.index (i, j, k);
        const double depth = -(height_of_row + plane[0] * i);
        if (depth > 0.0 && (free_space.empty () || !free_space[n]))
          raise (n, static_cast<float> (depth), static_cast<float> (beta));
      }
    }
  });
}

void
IntersectionConstraint::scaleWeights (double factor)
{
  for (float& beta : beta_)
    beta *= static_cast<float> (factor);
}

std::vector<LowerBound>
IntersectionConstraint::bounds () const
{
  std::vector<LowerBound> bounds (distance_vox_.size ());
  for (std::size_t n = 0; n < bounds.size (); ++n)
    if (distance_vox_[n] > 0.0f)
      bounds[n] = LowerBound (distance_vox_[n], beta_[n]);
  return bounds;
}

} // namespace pcl::cosection
