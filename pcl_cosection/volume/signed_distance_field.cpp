// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include <pcl/cosection/volume/signed_distance_field.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl
{
namespace cosection
{

std::optional<float>
SignedDistanceField::sample (const Eigen::Vector3d& p) const
{
  const Eigen::Vector3d v = grid.toVoxel (p);
  std::array<int, 3> lower;
  std::array<double, 3> fraction;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(v[axis] >= 0.0 && v[axis] <= grid.dims[axis] - 1))
      return std::nullopt;
    lower[axis] = std::max (0, std::min (static_cast<int> (v[axis]), grid.dims[axis] - 2));
    fraction[axis] = v[axis] - lower[axis];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    double weight = 1.0;
    std::array<int, 3> at = lower;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool upper = ((corner >> axis) & 1) != 0;
      weight *= (upper ? fraction[axis] : 1.0 - fraction[axis]);
      at[axis] += upper;
    }
    if (weight > 0.0) // else the corner may lie outside the grid, or hold no number
      sum += weight * values[grid.index (at[0], at[1], at[2])];
  }
  if (!std::isfinite (sum))
    return std::nullopt;
  return static_cast<float> (sum);
}

std::optional<float>
SignedDistanceField::sampleSupported (const Eigen::Vector3d& p) const
{
  const auto value = sample (p);
  if (!value || supported.empty ())
    return value;
  const Eigen::Vector3d v = grid.toVoxel (p);
  const auto nearest = [&] (int axis) { return static_cast<int> (std::floor (v[axis] + 0.5)); };
  if (supported[grid.index (nearest (0), nearest (1), nearest (2))] == 0)
    return std::nullopt;
  return value;
}

} // namespace cosection
} // namespace pcl
