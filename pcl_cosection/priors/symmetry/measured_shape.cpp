// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "measured_shape.h"

#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr float least_weight = 1e-4f; // of the data term where it says something
constexpr float behind_vox = -1.0f;   // deeper below the surface nothing is known
constexpr float far_vox = 12.0f;      // distances are cut off there
constexpr float carved_vox = -3.0f;   // the finer border of free space is known to this depth

} // namespace

MeasuredShape
measuredShape (const BodyEnergy& energy)
{
  const std::size_t size = energy.grid.size ();
  const auto isMeasured = [&] (std::size_t n) { return energy.problem.weight[n] > least_weight && !energy.empty[n]; };
  const auto measured = [&] (std::size_t n) { return energy.problem.weighted_target[n] / energy.problem.weight[n]; };
  std::vector<std::uint8_t> empty (size), rest (size);
  for (std::size_t n = 0; n < size; ++n)
  {
    empty[n] = energy.empty[n] || (isMeasured (n) && measured (n) > 0.0f);
    rest[n] = !empty[n];
  }
  const std::vector<float> outside = distanceTransform (energy.grid.dims, rest, energy.options.threads);
  const std::vector<float> inside = distanceTransform (energy.grid.dims, empty, energy.options.threads);

  MeasuredShape shape;
  shape.field.grid = energy.grid;
  shape.field.values.resize (size);
  shape.known.assign (size, 0);
  for (std::size_t n = 0; n < size; ++n)
  {
    float value = empty[n] ? outside[n] - 0.5f : 0.5f - inside[n];
    if (isMeasured (n))
    {
      value = measured (n);
      shape.known[n] = value > behind_vox && energy.data[n];
    }
    else
    {
      shape.known[n] = energy.empty[n];
      if (!energy.carved.empty () && energy.carved[n] > std::max (value, carved_vox))
      {
        value = energy.carved[n];
        shape.known[n] |= value > 0.0f;
      }
    }
    shape.field.values[n] = std::clamp (value, -far_vox, far_vox);
  }
  return shape;
}

} // namespace pcl::cosection
