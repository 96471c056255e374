// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/volume/signed_distance_field.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl::cosection {
namespace {

/** \brief The number of the voxel nearest to \a v, voxel coordinates; nothing outside the voxel centres' box. */
std::optional<std::size_t>
nearestVoxel (const VoxelGrid& grid, const Eigen::Vector3d& v)
{
  if (!((v.array () >= 0.0).all () && (v.array () <= grid.dims.cast<double> ().array () - 1.0).all ()))
    return std::nullopt;
  const Eigen::Array3i nearest = (v.array () + 0.5).cast<int> ();
  return grid.index (nearest.x (), nearest.y (), nearest.z ());
}

} // namespace

std::optional<float>
SignedDistanceField::sample (const Eigen::Vector3d& p) const
{
  return sampleVoxel (grid.toVoxel (p));
}

std::optional<float>
SignedDistanceField::sampleVoxel (const Eigen::Vector3d& v) const
{
  std::array<int, 3> lower;
  std::array<float, 3> fraction;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(v[axis] >= 0.0 && v[axis] <= grid.dims[axis] - 1))
      return std::nullopt;
    lower[axis] = std::max (0, std::min (static_cast<int> (v[axis]), grid.dims[axis] - 2));
    fraction[axis] = static_cast<float> (v[axis] - lower[axis]);
  }
  const float* corner = values.data () + grid.index (lower[0], lower[1], lower[2]);
  // A corner without weight may lie outside the grid, or hold no number.
  const auto mix = [] (float t, auto&& at_0, auto&& at_1) {
    return t <= 0.0f ? at_0 () : t >= 1.0f ? at_1 () : (1.0f - t) * at_0 () + t * at_1 ();
  };
  const auto along_x = [&] (std::ptrdiff_t offset) {
    return mix (
        fraction[0], [&] { return corner[offset]; }, [&] { return corner[offset + 1]; });
  };
  const std::ptrdiff_t row = grid.dims.x ();
  const auto along_y = [&] (std::ptrdiff_t offset) {
    return mix (
        fraction[1], [&] { return along_x (offset); }, [&] { return along_x (offset + row); });
  };
  const float value = mix (
      fraction[2], [&] { return along_y (0); }, [&] { return along_y (row * grid.dims.y ()); });
  if (!std::isfinite (value))
    return std::nullopt;
  return value;
}

std::optional<float>
SignedDistanceField::sampleInside (const Eigen::Vector3d& v) const
{
  const std::optional<std::size_t> nearest = nearestVoxel (grid, v);
  if (!nearest || !mayBeInside (*nearest))
    return std::nullopt;
  const std::optional<float> value = sampleVoxel (v);
  return value && *value < 0.0f ? value : std::nullopt;
}

std::optional<float>
SignedDistanceField::sampleSupported (const Eigen::Vector3d& p) const
{
  const Eigen::Vector3d v = grid.toVoxel (p);
  const std::optional<std::size_t> nearest = nearestVoxel (grid, v);
  return nearest && (supported.empty () || supported[*nearest] != 0) ? sampleVoxel (v) : std::nullopt;
}

} // namespace pcl::cosection
