// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_volumes.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/fusion/association/frame_labels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl::cosection {
namespace {

// The volume of the background.
constexpr double largest_voxel_m = 0.02;
constexpr double smallest_voxel_m = 0.002;
constexpr double first_share = 0.8;    // of the volume's side, the box of the first frame
constexpr double outlier_share = 0.02; // of the points, at either end of each axis
constexpr int points_of_box = 5000;
constexpr std::size_t min_background_points = 50;
constexpr int shift_step = 16;           // voxels
constexpr double tolerated_share = 0.05; // of the volume's side that may be out of it before it is shifted

// The volumes of objects.
constexpr double placing_share = 0.1; // of the points, at either end of each axis
constexpr double edge_factor = 2.0;
constexpr double growing_share = 0.02;
constexpr double margin_share = 0.1; // of a volume's side, around its points
constexpr int growth_step = 8;       // voxels
constexpr std::size_t min_object_points = 20;
constexpr int mask_border_px = 2; // beside an object, pixels are mixed with its own

/** \brief Box of a frame's points without outliers, world frame; empty: there are too few. */
Eigen::AlignedBox3d
seenBox (const PosedFrame& frame)
{
  const FrameCloud& cloud = frame.cloud;
  const double pixels = static_cast<double> (cloud.camera.width) * cloud.camera.height;
  const std::vector<Eigen::Vector3f> points = cloud.sample (
      std::max (1, static_cast<int> (std::sqrt (pixels / points_of_box))));
  if (points.size () < min_background_points)
    return {};
  return trimmedBox<double> (points, outlier_share, [&] (const Eigen::Vector3f& p) -> Eigen::Vector3d {
    return frame.T_world_camera * p.cast<double> ();
  });
}

/** \brief The volume's grid around the box that the first frame shows. */
VoxelGrid
placeBackground (const Eigen::AlignedBox3d& seen, const Eigen::Vector3d& camera, const DynamicFusionOptions& options)
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

/** \brief Box of points at \a T without a share of them at either end of each axis. */
Eigen::AlignedBox3d
boxWithout (double share, const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T)
{
  return trimmedBox<double> (points, share, [&T] (const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return (T * p.cast<double> ()).cast<float> ();
  });
}

/** \brief Make room for points near the volume's sides or beyond; its voxels stay.
 * \return whether the volume holds them, without outliers */
bool
growVolume (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_object_sensor, int max_resolution,
            TsdfVolume& volume)
{
  if (points.size () < min_object_points)
    return true;
  const VoxelGrid& grid = volume.grid ();
  const Eigen::AlignedBox3d box = boxWithout (growing_share, points, T_object_sensor);
  const Eigen::Array3d margin = margin_share * grid.dims.cast<double> ().array ();
  const Eigen::Array3d low = grid.toVoxel (box.min ()).array () - margin;
  const Eigen::Array3d high = grid.toVoxel (box.max ()).array () + margin;
  Eigen::Vector3i offset = Eigen::Vector3i::Zero ();
  Eigen::Vector3i dims = grid.dims;
  bool fits = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto steps = [] (double voxels) {
      return voxels > 0.0 ? growth_step * static_cast<int> (std::ceil (std::min (voxels, 1e6) / growth_step)) : 0;
    };
    const int room = std::max (0, max_resolution - grid.dims[axis]);
    const int before = steps (-low[axis]);
    const int after = steps (high[axis] - (grid.dims[axis] - 1));
    offset[axis] = std::min (before, room);
    const int behind = std::min (after, room - offset[axis]);
    fits = fits && offset[axis] == before && behind == after;
    dims[axis] += offset[axis] + behind;
  }
  if (dims != grid.dims)
    volume.grow (offset, dims);
  return fits;
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
    background.emplace (placeBackground (seen, frame.T_world_camera.translation (), setup.options),
                        setup.background_tsdf);
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

std::optional<VoxelGrid>
placeObjectVolume (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_sensor, int resolution)
{
  if (points.size () < min_object_points)
    return std::nullopt;
  const Eigen::AlignedBox3d box = boxWithout (placing_share, points, T_world_sensor);
  const double edge = edge_factor * box.sizes ().maxCoeff ();
  if (!(edge > 0.0 && std::isfinite (edge)))
    return std::nullopt;
  VoxelGrid grid;
  grid.dims.setConstant (resolution);
  grid.voxel_size_m = edge / resolution;
  grid.origin_m = box.center () - Eigen::Vector3d::Constant (0.5 * grid.voxel_size_m * (resolution - 1));
  return grid;
}

double
volumeOverlap (const VoxelGrid& a, const VoxelGrid& b, const Eigen::Isometry3d& T_world_b)
{
  constexpr int samples = 12; // along each axis
  const Eigen::Isometry3d T_b_world = T_world_b.inverse ();
  int inside = 0;
  for (int n = 0; n < samples * samples * samples; ++n)
  {
    const Eigen::Array3d place (n % samples, n / samples % samples, n / samples / samples);
    const Eigen::Array3d share = (place + 0.5) / samples;
    const Eigen::Vector3d p = a.origin_m + a.voxel_size_m * (share * a.dims.cast<double> ().array () - 0.5).matrix ();
    inside += b.nearest (T_b_world * p).has_value ();
  }
  const auto size = [] (const VoxelGrid& grid) {
    return static_cast<double> (grid.size ()) * std::pow (grid.voxel_size_m, 3);
  };
  const double common = size (a) * inside / (samples * samples * samples);
  return common / (size (a) + size (b) - common);
}

void
growVolumes (const PosedFrame& frame, const LabelImage& labels, int max_resolution, ObjectMap& objects, EventLog& log)
{
  for (auto& [id, object] : objects.by_id)
  {
    if (!object.isTracked ())
      continue;
    const Eigen::Vector3i before = object.volume->grid ().dims;
    if (!growVolume (frame.cloud.pointsOf (labels, static_cast<std::uint16_t> (id)),
                     object.T_world_object.inverse () * frame.T_world_camera, max_resolution, *object.volume) &&
        !object.reached_max_size)
    {
      object.reached_max_size = true;
      log.add (frame.stamp, "object ", id, " is larger than ", max_resolution, " voxels: the rest is left out");
    }
    const Eigen::Vector3i& now = object.volume->grid ().dims;
    if (now != before)
      log.add (frame.stamp, "the volume of object ", id, " grows to ", now.x (), " x ", now.y (), " x ", now.z (),
               " voxels");
  }
}

void
countAbsorbed (const PosedFrame& frame, const LabelImage& labels, const LabelMap& whole_of, ObjectMap& objects)
{
  for (auto& [id, object] : objects.by_id)
  {
    const auto label = static_cast<std::uint16_t> (id);
    if (std::any_of (whole_of.begin (), whole_of.end (), [label] (const auto& part) { return part.second == label; }))
      object.volume->countForeground (frame.cloud.reliable, frame.cloud.camera,
                                      object.T_world_object.inverse () * frame.T_world_camera, labels, label);
  }
}

void
integrateFrame (const RgbdFrame& images, const PosedFrame& frame, const LabelImage& labels, bool masked,
                TsdfVolume& background, ObjectMap& objects)
{
  const Image<float>& depth = frame.cloud.reliable;
  const PinholeCamera& camera = frame.cloud.camera;
  TsdfPixels pixels;
  pixels.labels = &labels;
  background.integrate (depth, camera, frame.T_world_camera, pixels);
  if (masked && background.options ().foreground)
    background.countForeground (depth, camera, frame.T_world_camera, labels, 0);
  if (objects.by_id.empty ())
    return;
  const LabelImage wide = widened (labels, mask_border_px);
  if (images.colour.pixels.size () == labels.pixels.size ())
    pixels.colours = &images.colour;
  for (auto& [id, object] : objects.by_id)
  {
    if (!object.isTracked ())
      continue;
    pixels.label = static_cast<std::uint16_t> (id);
    const Eigen::Isometry3d T_object_camera = object.T_world_object.inverse () * frame.T_world_camera;
    object.volume->integrate (depth, camera, T_object_camera, pixels);
    object.volume->integrateFreeSpace (depth, camera, T_object_camera, wide, pixels.label);
    if (masked)
      object.volume->countForeground (depth, camera, T_object_camera, labels, pixels.label);
  }
}

} // namespace pcl::cosection
