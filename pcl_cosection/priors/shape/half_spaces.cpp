// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "half_spaces.h"

#include <algorithm>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double rounding = 1e-6; // relative bound of the rounding errors of a row's values

} // namespace

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

HalfSpaces
HalfSpaces::within (const Eigen::AlignedBox3d& box) const
{
  const Eigen::Vector3d middle = box.center ();
  const Eigen::Vector3d half_sizes = 0.5 * box.sizes ();
  double least = -std::numeric_limits<double>::infinity (); // lower bound of the maximum over k in the box
  for (const auto& [n, s] : sides_)
    least = std::max (least, n.dot (middle) - s - n.cwiseAbs ().dot (half_sizes));
  const double tolerance = rounding * (middle.norm () + half_sizes.norm ());
  HalfSpaces needed;
  for (const auto& [n, s] : sides_)
    if (n.dot (middle) - s + n.cwiseAbs ().dot (half_sizes) >= least - tolerance)
      needed.add (n, s);
  return needed;
}

} // namespace pcl::cosection
