// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/volume/tsdf_volume.h>

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/require.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace pcl::cosection {
namespace {

constexpr float unseen = std::numeric_limits<float>::quiet_NaN ();

constexpr TriangleMesh::Colour colour_unknown = {128, 128, 128};

constexpr double max_voxels = 1e12;      ///< more than any memory holds, and far from overflow
constexpr double max_truncation_m = 1e9; ///< far from what stands for no distance

void
checkGrid (const VoxelGrid& grid, const TsdfOptions& options)
{
  if (grid.dims.minCoeff () < 1 || !(grid.dims.cast<double> ().prod () <= max_voxels))
    throw InvalidArgument (
        "TSDF volume: the grid must have at least one voxel along each axis, and at most 1e12 in all");
  if (!isPositive (grid.voxel_size_m))
    throw InvalidArgument ("TSDF volume: the voxel size must be positive");
  if (!grid.origin_m.allFinite ())
    throw InvalidArgument ("TSDF volume: the grid's origin must be finite");
  if (!(options.truncation_vox * grid.voxel_size_m <= max_truncation_m))
    throw InvalidArgument ("TSDF volume: the truncation distance must be at most 1e9 m");
}

} // namespace

void
TsdfOptions::validate () const
{
  if (!isPositive (truncation_vox))
    throw InvalidArgument ("truncation_vox must be positive");
  if (!(max_weight > 0.0 && max_weight <= std::numeric_limits<float>::max ()))
    throw InvalidArgument ("max_weight must be positive");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

std::size_t
TsdfVolume::estimateBytes (const VoxelGrid& grid, const TsdfOptions& options)
{
  options.validate ();
  checkGrid (grid, options);
  return grid.size () * (2 * sizeof (float) + (options.colour ? sizeof (ColourVoxel) : 0) +
                         (options.foreground ? sizeof (LabelCounts) : 0));
}

TsdfVolume::TsdfVolume (const VoxelGrid& grid, const TsdfOptions& options) : options_ (options)
{
  options.validate ();
  checkGrid (grid, options);
  field_.grid = grid;
  field_.values.assign (grid.size (), unseen);
  weights_.assign (grid.size (), 0.0f);
  if (options.colour)
    colours_.resize (grid.size ());
  if (options.foreground)
    counts_.resize (grid.size ());
}

void
TsdfVolume::grow (const Eigen::Vector3i& offset, const Eigen::Vector3i& dims)
{
  const Eigen::Array3d end = offset.cast<double> () + grid ().dims.cast<double> (); // which an int may not hold
  if ((offset.array () < 0).any () || (end > dims.cast<double> ().array ()).any ())
    throw InvalidArgument ("TSDF volume: growing must not lose voxels");
  reframe (offset, dims);
}

void
TsdfVolume::reframe (const Eigen::Vector3i& offset, const Eigen::Vector3i& dims)
{
  VoxelGrid moved = grid ();
  moved.dims = dims;
  moved.origin_m -= moved.voxel_size_m * offset.cast<double> ();
  checkGrid (moved, options_);
  // Voxel v is voxel v + shift then. A shift beyond all voxels is as good as one by the size of the grid, and cannot
  // overflow.
  const Eigen::Vector3i shift = offset.cwiseMax (-grid ().dims).cwiseMin (dims);
  const Eigen::Array3i begin = (-shift.array ()).max (0); // of the voxels that stay
  const Eigen::Array3i end = (dims - shift).array ().min (grid ().dims.array ());
  const auto movedValues = [&] (const auto& values, const auto& empty) {
    std::decay_t<decltype (values)> result (values.empty () ? 0 : moved.size (), empty);
    if (!values.empty () && (begin < end).all ())
      parallelFor (begin.z (), end.z (), threadsForVoxels (options_.threads, grid ().size ()), [&] (int k) {
        for (int j = begin.y (); j < end.y (); ++j)
        {
          const Eigen::Vector3i target = Eigen::Vector3i (begin.x (), j, k) + shift;
          std::copy_n (&values[grid ().index (begin.x (), j, k)], end.x () - begin.x (),
                       &result[moved.index (target.x (), target.y (), target.z ())]);
        }
      });
    return result;
  };
  auto values = movedValues (field_.values, unseen);
  auto weights = movedValues (weights_, 0.0f);
  auto colours = movedValues (colours_, ColourVoxel ());
  auto counts = movedValues (counts_, LabelCounts ());
  // From here on nothing can fail.
  field_.values.swap (values);
  weights_.swap (weights);
  colours_.swap (colours);
  counts_.swap (counts);
  field_.grid = moved;
}

std::optional<float>
TsdfVolume::foregroundProbability (const Eigen::Vector3d& p) const
{
  const auto v = grid ().nearest (p);
  if (!v || counts_.empty ())
    return std::nullopt;
  const LabelCounts& counts = counts_[grid ().index (v->x (), v->y (), v->z ())];
  const int total = counts.foreground + counts.background;
  if (total == 0)
    return std::nullopt;
  return static_cast<float> (counts.foreground) / static_cast<float> (total);
}

std::optional<TriangleMesh::Colour>
TsdfVolume::colour (const Eigen::Vector3d& p) const
{
  if (colours_.empty () || !grid ().nearest (p))
    return std::nullopt;
  const Eigen::Vector3d v = grid ().toVoxel (p);
  const Eigen::Vector3i lower = v.array ().floor ().cast<int> ();
  const Eigen::Vector3d fraction = v - lower.cast<double> ();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  double weights = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3i step (corner & 1, (corner >> 1) & 1, corner >> 2);
    const Eigen::Vector3i voxel = lower + step;
    if (!grid ().contains (voxel.x (), voxel.y (), voxel.z ()))
      continue;
    const ColourVoxel& c = colours_[grid ().index (voxel.x (), voxel.y (), voxel.z ())];
    if (c.weight == 0)
      continue;
    double w = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      w *= (step[axis] ? fraction[axis] : 1.0 - fraction[axis]);
    sum += w * Eigen::Vector3d (c.rgb[0], c.rgb[1], c.rgb[2]);
    weights += w;
  }
  if (!(weights > 0.0))
    return std::nullopt;
  TriangleMesh::Colour colour;
  for (int channel = 0; channel < 3; ++channel)
    colour[channel] = static_cast<std::uint8_t> (std::min (255.0, sum[channel] / weights / 256.0 + 0.5));
  return colour;
}

TriangleMesh
TsdfVolume::surfaceMesh (double min_weight) const
{
  if (!(min_weight >= 0.0))
    throw InvalidArgument ("TSDF volume: the least weight of a surface must not be negative");
  std::vector<std::uint8_t> supported (grid ().size ());
  const std::size_t slice = static_cast<std::size_t> (grid ().dims.x ()) * grid ().dims.y ();
  parallelFor (0, grid ().dims.z (), threadsForVoxels (options_.threads, grid ().size ()), [&] (int k) {
    for (std::size_t v = k * slice; v < (k + 1) * slice; ++v)
      supported[v] = static_cast<std::uint8_t> (weights_[v] > 0.0f && weights_[v] >= min_weight);
  });
  TriangleMesh mesh = extractOpenIsoSurface (field_, supported, options_.threads);
  if (!colours_.empty ())
  {
    mesh.colours.resize (mesh.vertices.size ());
    parallelFor (0, static_cast<int> (mesh.vertices.size ()), options_.threads, [&] (int v) {
      mesh.colours[v] = colour (mesh.vertices[v].cast<double> ()).value_or (colour_unknown);
    });
  }
  return mesh;
}

} // namespace pcl::cosection
