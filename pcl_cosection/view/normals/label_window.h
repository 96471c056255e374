// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace pcl::cosection {

/** \brief Half of the window in which the readings of a label are compared, pixels: as the largest one of
 * computeOrganizedNormals (). */
constexpr int label_window_px = 7;

/** \brief Call \a visit (pixel, du, dv) at the readings of the window around \a i that have its label. */
template <typename Visit>
void
visitLabelWindow (const SensorCloud& cloud, std::size_t i, Visit&& visit)
{
  const auto row = static_cast<int> (i / cloud.width);
  const auto column = static_cast<int> (i % cloud.width);
  const int top = std::max (0, row - label_window_px), bottom = std::min (cloud.height - 1, row + label_window_px);
  const int left = std::max (0, column - label_window_px), right = std::min (cloud.width - 1, column + label_window_px);
  for (int v = top; v <= bottom; ++v)
    for (int u = left; u <= right; ++u)
    {
      const std::size_t j = static_cast<std::size_t> (v) * cloud.width + u;
      if (cloud.labels[j] == cloud.labels[i] && cloud.positions[j].allFinite ())
        visit (j, u - column, v - row);
    }
}

/** \brief The readings of objects, not of label 0, that have no normal. */
inline std::vector<std::size_t>
objectReadingsWithoutNormals (const Members& members, const SensorCloud& cloud)
{
  std::vector<std::size_t> result;
  for (const auto& [label, readings] : members)
    if (label != 0)
      std::copy_if (readings.begin (), readings.end (), std::back_inserter (result),
                    [&] (std::size_t i) { return !cloud.normals[i].allFinite (); });
  return result;
}

} // namespace pcl::cosection
