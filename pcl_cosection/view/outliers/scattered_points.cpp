// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scattered_points.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();
constexpr int scattered_neighbours = 20; // of which the farthest ...
constexpr float scattered_factor = 4.0f; // ... is so much farther than usual: the point shows no surface

} // namespace

void
leaveOutScattered (const PcdViewOptions& options, const Surroundings& objects,
                   const std::vector<std::size_t>& background, SensorCloud& cloud)
{
  const std::vector<float> reach = neighbourDistances (pick (cloud.positions, background), scattered_neighbours,
                                                       options.threads);
  std::vector<bool> scattered (background.size (), true);
  for (const auto& [label, box] : objects)
  {
    std::vector<std::size_t> near;
    std::vector<float> sorted;
    for (std::size_t k = 0; k < background.size (); ++k)
      if (box.contains (cloud.positions[background[k]]))
      {
        near.push_back (k);
        sorted.push_back (reach[k]);
      }
    if (near.empty ())
      continue;
    const float usual = upperMedian (sorted);
    for (const std::size_t k : near)
      if (reach[k] <= scattered_factor * usual)
        scattered[k] = false;
  }
  for (std::size_t k = 0; k < background.size (); ++k)
    if (scattered[k])
      cloud.normals[background[k]].setConstant (nan_value);
}

} // namespace pcl::cosection
