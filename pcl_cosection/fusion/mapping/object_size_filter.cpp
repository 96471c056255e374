// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "object_size_filter.h"

#include <cmath>
#include <cstddef>

namespace pcl::cosection
{

namespace
{

constexpr double voxel_m = 0.05; // larger than errors of poses
constexpr int key_bits = 21;     // of each coordinate: 100 km

std::uint64_t
keyOf (const Eigen::Vector3d& p)
{
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << key_bits |
          (static_cast<std::uint64_t> (std::llround (p[axis] / voxel_m)) & ((std::uint64_t (1) << key_bits) - 1));
  return key;
}

} // namespace

void
ObjectSizeFilter::filter (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_camera,
                          ObjectSegmentation& found)
{
  ++frame_;
  std::vector<std::size_t> pixels (found.objects + 1, 0), too_long (found.objects + 1, 0);
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const std::uint32_t label = found.labels[n];
    if (label == 0 && !found.too_long[n])
      continue;
    Frames& frames = counts_[keyOf (T_world_camera * points[n].cast<double> ())];
    if (frames.counted != frame_)
      ++(label == 0 ? frames.too_long : frames.object);
    frames.counted = frame_;
    ++pixels[label];
    too_long[label] += frames.too_long > frames.object;
  }
  for (std::uint32_t& label : found.labels)
    if (label != 0 && 2 * too_long[label] > pixels[label])
      label = 0;
}

} // namespace pcl::cosection
