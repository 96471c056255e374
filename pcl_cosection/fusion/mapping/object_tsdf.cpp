// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_tsdf.h"

#include "pcl_cosection/common/boxes.h"

#include <pcl/cosection/common/error.h>

#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double outlier_share = 0.01; // of the points, at either end of each axis
constexpr double core_share = 0.1;     // of the points; without these, outliers of a mask do not count
constexpr std::size_t min_points = 20;

/** \brief Bounding box of points without a share of them at either end of each axis. */
Eigen::AlignedBox3d
boxWithout (double share, const std::vector<OrientedPoint>& points)
{
  return trimmedBox<double> (points, share, [] (const OrientedPoint& point) { return point.position; });
}

/** \brief Whether a volume of at most so many voxels along a side can grow to hold a box. */
bool
canHold (const VoxelGrid& grid, const Eigen::AlignedBox3d& box, int max_resolution)
{
  const Eigen::Array3d low = grid.toVoxel (box.min ()).array ().min (0.0);
  const Eigen::Array3d high = grid.toVoxel (box.max ()).array ().max (grid.dims.cast<double> ().array () - 1.0);
  return (high - low < max_resolution).all ();
}

VoxelGrid
gridAround (const Eigen::AlignedBox3d& box, double voxel_size_m, int max_resolution)
{
  VoxelGrid grid;
  grid.voxel_size_m = voxel_size_m;
  const Eigen::Array3d wanted = (box.sizes () / voxel_size_m).array ().ceil () + 1.0;
  grid.dims = wanted.min (max_resolution).cast<int> ().matrix ();
  grid.origin_m = box.center () - 0.5 * voxel_size_m * (grid.dims.cast<double> ().array () - 1.0).matrix ();
  return grid;
}

} // namespace

void
ObjectTsdfOptions::validate () const
{
  if (resolution < 8)
    throw InvalidArgument ("resolution must be at least 8");
  if (!(margin >= 0.0 && std::isfinite (margin)))
    throw InvalidArgument ("margin must not be negative");
  if (max_resolution < resolution)
    throw InvalidArgument ("max_resolution must not be smaller than resolution");
  tsdf.validate ();
}

ObjectTsdf::ObjectTsdf (const ObjectTsdfOptions& options) : options_ (options)
{
  options.validate ();
}

void
ObjectTsdf::makeRoom (const std::vector<OrientedPoint>& points)
{
  if (points.size () < min_points)
    return;
  const Eigen::AlignedBox3d seen = boxWithout (outlier_share, points);
  const double longest = seen.sizes ().maxCoeff ();
  if (!(longest > 0.0) || !std::isfinite (longest))
    return;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (options_.margin * longest);
  const Eigen::AlignedBox3d wanted (seen.min () - margin, seen.max () + margin);
  if (!volume_ || !canHold (volume_->grid (), boxWithout (core_share, points), options_.max_resolution))
  {
    volume_.emplace (gridAround (wanted, longest / options_.resolution, options_.max_resolution), options_.tsdf);
    return;
  }
  const VoxelGrid& grid = volume_->grid ();
  const Eigen::Array3i dims = grid.dims.array ();
  // Clamped before the conversion to int.
  const Eigen::Array3d most = Eigen::Array3d::Constant (options_.max_resolution);
  const Eigen::Array3i low = grid.toVoxel (wanted.min ()).array ().floor ().max (-most).cast<int> ().min (0);
  const Eigen::Array3i
      high = grid.toVoxel (wanted.max ()).array ().ceil ().min (2.0 * most).cast<int> ().max (dims - 1);
  const Eigen::Array3i offset = (-low).min ((options_.max_resolution - dims).max (0));
  const Eigen::Array3i size = (offset + high + 1).min (options_.max_resolution).max (dims + offset);
  if ((size != dims).any ())
    volume_->grow (offset.matrix (), size.matrix ());
}

void
ObjectTsdf::integrate (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_object_sensor,
                       const TsdfPixels& pixels)
{
  if (volume_)
    volume_->integrate (depth, camera, T_object_sensor, pixels);
}

} // namespace pcl::cosection
