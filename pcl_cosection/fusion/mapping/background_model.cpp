// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "background_model.h"

#include "pcl_cosection/common/trimmed_box.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double largest_voxel_m = 0.02;
constexpr double smallest_voxel_m = 0.002;
constexpr double first_share = 0.8;    // of the volume's side, the box of the first frame
constexpr double outlier_share = 0.02; // of the points, at either end of each axis
constexpr int points_of_box = 5000;
constexpr std::size_t min_points = 50;
constexpr int shift_step = 16;           // voxels
constexpr double tolerated_share = 0.05; // of the volume's side that may be out of it before it is shifted

/** \brief Box of a frame's points without outliers, world frame; empty: there are too few. */
Eigen::AlignedBox3d
seenBox (const PosedFrame& frame)
{
  const FrameCloud& cloud = frame.cloud;
  const double pixels = static_cast<double> (cloud.camera.width) * cloud.camera.height;
  const std::vector<Eigen::Vector3f> points = cloud.sample (
      std::max (1, static_cast<int> (std::sqrt (pixels / points_of_box))));
  if (points.size () < min_points)
    return {};
  return trimmedBox<double> (points, outlier_share, [&] (const Eigen::Vector3f& p) -> Eigen::Vector3d {
    return frame.T_world_camera * p.cast<double> ();
  });
}

/** \brief The volume's grid around the box that the first frame shows. */
VoxelGrid
placeGrid (const Eigen::AlignedBox3d& seen, const Eigen::Vector3d& camera, const DynamicFusionOptions& options)
{
  const int resolution = options.background_resolution;
  VoxelGrid grid;
  grid.dims.setConstant (resolution);
  const double fitting = seen.sizes ().maxCoeff () / (first_share * resolution);
  grid.voxel_size_m = options.background_voxel_size_m > 0.0
                          ? options.background_voxel_size_m
                          : std::min (largest_voxel_m, std::max (smallest_voxel_m, fitting));
  const double half = 0.5 * grid.voxel_size_m * (resolution - 1);
  Eigen::Vector3d centre = seen.center ();
  // A scene that is too large is held from the camera on.
  for (int axis = 0; axis < 3; ++axis)
    if (seen.sizes ()[axis] > 2.0 * half)
      centre[axis] = camera[axis] < centre[axis] ? seen.min ()[axis] + half : seen.max ()[axis] - half;
  grid.origin_m = centre - Eigen::Vector3d::Constant (half);
  return grid;
}

} // namespace

void
followBackground (const PosedFrame& frame, const FusionSetup& setup, std::optional<TsdfVolume>& background)
{
  const Eigen::AlignedBox3d seen = seenBox (frame);
  if (seen.isEmpty ())
    return;
  if (!background)
  {
    background.emplace (placeGrid (seen, frame.T_world_camera.translation (), setup.options), setup.background_tsdf);
    return;
  }
  const VoxelGrid& grid = background->grid ();
  Eigen::Vector3i offset = Eigen::Vector3i::Zero ();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double last = grid.dims[axis] - 1.0;
    const double below = grid.toVoxel (seen.min ())[axis];
    const double above = grid.toVoxel (seen.max ())[axis] - last;
    const double tolerated = tolerated_share * last;
    // Where both ends are out, the volume stays: it cannot hold more.
    double shift = 0.0;
    if (below < -tolerated && above < 0.0)
      shift = std::min (-below, -above);
    else if (above > tolerated && below > 0.0)
      shift = -std::min (above, below);
    offset[axis] = shift_step * static_cast<int> (std::round (shift / shift_step));
  }
  if (!offset.isZero ())
    background->reframe (offset, grid.dims);
}

} // namespace pcl::cosection
