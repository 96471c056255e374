// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_surroundings.h"

#include "pcl_cosection/common/trimmed_box.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr double outermost_share = 0.02; // of an object's points on each side, which may be wrong
constexpr float nearness = 1.0f;         // to an object, of its longest side

} // namespace

Surroundings
surroundingsOf (const Members& members, const SensorCloud& cloud)
{
  Surroundings boxes;
  for (const auto& [label, indices] : members)
    if (label != 0)
    {
      const Eigen::AlignedBox3f box = trimmedBox<float> (indices, outermost_share,
                                                         [&] (std::size_t i) { return cloud.positions[i]; });
      const Eigen::Vector3f reach = Eigen::Vector3f::Constant (nearness * box.sizes ().maxCoeff ());
      boxes[label] = Eigen::AlignedBox3f (box.min () - reach, box.max () + reach);
    }
  return boxes;
}

BackgroundParts
partsOfBackground (const Surroundings& objects, const Members& members, const SensorCloud& cloud)
{
  BackgroundParts parts;
  if (const auto background = members.find (0); background != members.end ())
    for (const std::size_t i : background->second)
    {
      const bool near = std::any_of (objects.begin (), objects.end (),
                                     [&] (const auto& object) { return object.second.contains (cloud.positions[i]); });
      (near ? parts.near : parts.far).push_back (i);
    }
  return parts;
}

} // namespace pcl::cosection
