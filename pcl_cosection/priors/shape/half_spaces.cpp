// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "half_spaces.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection {
double
HalfSpaces::beyond (const Eigen::Vector3d& x) const
{
  float value = 0.0f;
  beyond (x, Eigen::Vector3d::Zero (), 1, &value);
  return value;
}

void
HalfSpaces::beyond (const Eigen::Vector3d& first, const Eigen::Vector3d& step, int count, float* values) const
{
  std::fill (values, values + count, empty () ? 0.0f : -std::numeric_limits<float>::infinity ());
  for (const auto& [n, s] : sides_)
  {
    const auto at_first = static_cast<float> (n.dot (first) - s);
    const auto per_step = static_cast<float> (n.dot (step));
    for (int i = 0; i < count; ++i)
    {
      const float value = at_first + static_cast<float> (i) * per_step;
      values[i] = values[i] < value ? value : values[i];
    }
  }
}

} // namespace pcl::cosection
