// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float unseen = std::numeric_limits<float>::quiet_NaN ();

constexpr double max_voxels = 1e12;      ///< more than any memory holds, and far from overflow
constexpr double max_truncation_m = 1e9; ///< far from what stands for no distance

bool
isPositive (double value)
{
  return value > 0.0 && std::isfinite (value);
}

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

/** \brief Where a grid's voxels are in another: voxel v is voxel v + offset there. */
struct Placement
{
  Eigen::Vector3i from;
  Eigen::Vector3i to;
  Eigen::Vector3i offset;

  /** \brief First voxel of \a from that is also in \a to. */
  Eigen::Array3i begin () const { return (-offset.array ()).max (0); }

  Eigen::Array3i end () const { return (to - offset).array ().min (from.array ()); }
};

/** \brief One value per voxel, moved to another grid; \a empty in voxels that were none. */
template <typename Value>
std::vector<Value>
movedValues (const std::vector<Value>& values, const Placement& placement, const Value& empty, int threads)
{
  if (values.empty ())
    return {};
  VoxelGrid from;
  VoxelGrid to;
  from.dims = placement.from;
  to.dims = placement.to;
  std::vector<Value> moved (to.size (), empty);
  const Eigen::Array3i begin = placement.begin ();
  const Eigen::Array3i end = placement.end ();
  if ((begin < end).all ())
    parallelFor (begin.z (), end.z (), threadsForVoxels (threads, from.size ()), [&] (int k) {
      for (int j = begin.y (); j < end.y (); ++j)
      {
        const Eigen::Vector3i target = Eigen::Vector3i (begin.x (), j, k) + placement.offset;
        std::copy_n (&values[from.index (begin.x (), j, k)], end.x () - begin.x (),
                     &moved[to.index (target.x (), target.y (), target.z ())]);
      }
    });
  return moved;
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
  // A shift beyond all voxels is as good as one by the size of the grid, and cannot overflow.
  const Placement placement{grid ().dims, dims, offset.cwiseMax (-grid ().dims).cwiseMin (dims)};
  auto values = movedValues (field_.values, placement, unseen, options_.threads);
  auto weights = movedValues (weights_, placement, 0.0f, options_.threads);
  auto colours = movedValues (colours_, placement, ColourVoxel (), options_.threads);
  auto counts = movedValues (counts_, placement, LabelCounts (), options_.threads);
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

} // namespace pcl::cosection
